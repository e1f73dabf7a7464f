// SPDX-License-Identifier: BSD-3-Clause
#include "tools/cli.hpp"
#include "tools/command_line/completion.hpp"
#include "tools/command_line/suggestion.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lilo {
namespace {

/// "lilo" with two commands, one of which has commands of its own.
class Tool : public testing::Test {
 protected:
  Tool() {
    app.require_subcommand(1);
    CLI::App* record = app.add_subcommand("record", "Write what comes");
    record->add_option("FILE", text_);
    record->add_option("--count", number_, "So many");
    record->add_option("--rate", number_, "How fast")->type_name("0..60");
    record->add_option("--how", text_, "In which way")->type_name("fast|slow");
    record->add_flag("--force", flag_, "At any price");
    CLI::App* bench = app.add_subcommand("bench", "Measure");
    bench->add_subcommand("paper", "The paper");
    bench->add_option("PATHS", text_);
    app.add_subcommand("secret")->group("");
  }

  [[nodiscard]] std::string completed(const std::vector<std::string>& words) const {
    const Completion completion = complete(app, words);
    std::string text;
    for (const auto& each : completion.candidates) text += each.word + ' ';
    return completion.files ? text + "FILES" : text;
  }

  std::string explained(const std::vector<std::string>& words) {
    try {
      app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as CLI11 wants them
    } catch (const CLI::ParseError& error) {
      return explain(app, words, error);
    }
    return "good";
  }

  CLI::App app{"the toolbox", "lilo"};

 private:
  std::string text_;
  int number_ = 0;
  bool flag_ = false;
};

TEST_F(Tool, CompletesCommands) {
  EXPECT_EQ(completed({""}), "record bench ");
  EXPECT_EQ(completed({"re"}), "record ");
  EXPECT_EQ(completed({"bench", ""}), "paper FILES");
  EXPECT_EQ(completed({"x"}), "");
}

TEST_F(Tool, CompletesOptions) {
  EXPECT_EQ(completed({"record", "--"}), "--help --count --rate --how --force ");
  EXPECT_EQ(completed({"record", "--force", "--c"}), "--count ");
}

TEST_F(Tool, CompletesValues) {
  EXPECT_EQ(completed({"record", ""}), "FILES");
  EXPECT_EQ(completed({"record", "--how", ""}), "fast slow ");
  EXPECT_EQ(completed({"record", "--how", "s"}), "slow ");
  EXPECT_EQ(completed({"record", "--count", ""}), "");  // a number: nothing to offer
  EXPECT_EQ(completed({"record", "--rate", ""}), "");
  EXPECT_EQ(completed({"record", "--count", "3", ""}), "FILES");
  EXPECT_EQ(completed({"record", "--force", ""}), "FILES");  // a flag takes no value
}

TEST_F(Tool, TheShellsGetALineEach) {
  EXPECT_EQ(to_text(complete(app, {"rec"})), "record\tWrite what comes\n");
  EXPECT_EQ(to_text(complete(app, {"record", "x"})), ":files\n");
}

TEST_F(Tool, SuggestsTheCommandThatWasMeant) {
  EXPECT_EQ(explained({"recrod"}), "recrod: no such command, did you mean record? (lilo --help)");
  EXPECT_EQ(explained({"quux"}), "quux: no such command (lilo --help)");
}

TEST_F(Tool, SuggestsTheOptionThatWasMeant) {
  EXPECT_EQ(explained({"record", "--cuont", "3"}),
            "--cuont: no such option, did you mean --count? (lilo record --help)");
  EXPECT_EQ(explained({"record", "--cuont=3"}),
            "--cuont: no such option, did you mean --count? (lilo record --help)");
}

enum class Speed : std::uint8_t { slow, fast };

TEST(OneOf, TakesNamesAndTellsThemToWhoeverMistypes) {
  const auto parsed = [](const std::string& word) -> std::string {
    CLI::App command{"x", "x"};
    Speed speed = Speed::slow;
    choice<Speed>(command.add_option("--speed", speed),
                  {{"slow", Speed::slow}, {"fast", Speed::fast}});
    EXPECT_EQ(command.get_option("--speed")->get_type_name(), "fast|slow");
    try {
      command.parse(std::vector<std::string>{word, "--speed"});
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
    return speed == Speed::fast ? "is fast" : "is slow";
  };
  EXPECT_EQ(parsed("fast"), "is fast");
  EXPECT_EQ(parsed("slow"), "is slow");
  EXPECT_EQ(parsed("fats"),
            "--speed: expected one of fast, slow, found 'fats', did you mean fast?");
  EXPECT_EQ(parsed("0"), "--speed: expected one of fast, slow, found '0'");
}

TEST_F(Tool, OtherMistakesAreToldAsTheyAre) {
  const std::string text = explained({"record", "--count", "many"});
  EXPECT_NE(text.find("many"), std::string::npos) << text;
  EXPECT_NE(text.find("(lilo record --help)"), std::string::npos) << text;
  EXPECT_EQ(explained({}), "A subcommand is required (lilo --help)");
}

}  // namespace
}  // namespace lilo
