// SPDX-License-Identifier: BSD-3-Clause
#include "tools/bench/worlds/worlds_report.hpp"

#include "tools/bench/worlds/comparison.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace lilo::worlds {
namespace {

TEST(Spread, IsThatOfASample) {
  const Spread spread = spread_of({2.0, 4.0, kUnknown, 9.0});
  EXPECT_EQ(spread.count, 3);
  EXPECT_DOUBLE_EQ(spread.mean, 5.0);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt((9.0 + 1.0 + 16.0) / 2.0));
  EXPECT_EQ(spread_of({7.0}).deviation, 0.0);
  EXPECT_EQ(spread_of({kUnknown}).count, 0);
}

TEST(Difference, BeyondTheSpreadIsTwoStandardErrors) {
  // 1, 2 and 3: mean 2, deviation 1, standard error 1 / sqrt 3.
  const Difference clear = difference_of({10.0, 20.0, 30.0}, {11.0, 22.0, 33.0});
  EXPECT_DOUBLE_EQ(clear.mean, 2.0);
  EXPECT_DOUBLE_EQ(clear.standard_error, 1.0 / std::sqrt(3.0));
  EXPECT_TRUE(clear.beyond_spread);
  // -1 and 3: mean 1, deviation sqrt 8, standard error 2.
  const Difference vague = difference_of({1.0, 1.0}, {0.0, 4.0});
  EXPECT_DOUBLE_EQ(vague.mean, 1.0);
  EXPECT_DOUBLE_EQ(vague.standard_error, 2.0);
  EXPECT_FALSE(vague.beyond_spread);
}

// Worlds differ by 10 from seed to seed and by 1 from variant to variant: only pairs show it.
TEST(Difference, IsTakenSeedBySeed) {
  const Difference d = difference_of({10.0, 20.0, 30.0}, {11.0, 21.0, 31.0});
  EXPECT_DOUBLE_EQ(d.mean, 1.0);
  EXPECT_TRUE(d.beyond_spread);
}

TEST(Difference, OfOneSeedOrNoneOrNothingIsNotBeyond) {
  EXPECT_FALSE(difference_of({1.0}, {5.0}).beyond_spread);
  EXPECT_FALSE(difference_of({1.0, kUnknown}, {5.0, 6.0}).beyond_spread);
  EXPECT_EQ(difference_of({kUnknown}, {5.0}).count, 0);
  EXPECT_FALSE(difference_of({3.0, 4.0}, {3.0, 4.0}).beyond_spread);
}

Outcome outcome(const std::string& world, std::uint64_t seed, const std::vector<double>& ate_m) {
  Outcome outcome;
  outcome.drive.world.name = world;
  outcome.drive.seed = seed;
  outcome.drive.role = seed < 20 ? Role::choose : Role::report;
  for (const double ate : ate_m) {
    outcome.figures.push_back({.ate_m = ate, .tracking_percent = 99.0, .cpu_p50_ms = 1.25});
  }
  return outcome;
}

Outcome without(const std::string& world, std::uint64_t seed, bool skipped) {
  Outcome out = outcome(world, seed, {});
  out.trouble = "it is not here";
  out.skipped = skipped;
  return out;
}

/// The line that begins so, with one space between its words; or nothing.
std::string line_of(const std::string& text, const std::string& begin) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string found;
    for (std::string word; words >> word;) found += (found.empty() ? "" : " ") + word;
    if (found.starts_with(begin)) return found;
  }
  return "";
}

TEST(WorldsReport, HasALineAWorldAndRole) {
  const std::string text =
      to_text({outcome("park", 11, {0.5}), outcome("park", 12, {0.75}), outcome("park", 21, {3.0}),
               without("park", 22, true), without("town", 11, false)});
  // Of 0.5 and 0.75: sqrt(2) / 8.
  EXPECT_EQ(line_of(text, "park choose"),
            "park choose 11 12 - - 0.625+-0.177 - - 99.0 - - - - - 1.25 - - -");
  EXPECT_EQ(line_of(text, "park report"), "park report 21 - - 3.000 - - 99.0 - - - - - 1.25 - - -");
  EXPECT_EQ(line_of(text, "skipped"), "skipped park 22: it is not here");
  EXPECT_EQ(line_of(text, "failed"), "failed town 11: it is not here");
  EXPECT_EQ(line_of(text, "town"), "") << "a line of figures without any";
  EXPECT_EQ(text.find("second"), std::string::npos);
}

TEST(WorldsReport, SaysWhatIsBeyondTheSpread) {
  const std::string text =
      to_text({outcome("park", 11, {0.5, 0.75}), outcome("park", 12, {0.75, 1.0}),
               outcome("town", 11, {2.0, 1.0}), outcome("town", 12, {1.0, 1.5}),
               outcome("town", 21, {1.0, 0.5})});
  const std::string differences = text.substr(text.find("second minus first"));
  EXPECT_EQ(line_of(differences, "park choose"),
            "park choose 11 12 - - +0.250+-0.000* - - = - - - - - = - - -");
  EXPECT_EQ(line_of(differences, "town choose"),
            "town choose 11 12 - - -0.250+-0.750 - - = - - - - - = - - -");
  EXPECT_EQ(line_of(differences, "town report"),
            "town report 21 - - -0.500 - - = - - - - - = - - -");
  EXPECT_NE(text.find("\n  ATE m: higher in park (choose)\n"), std::string::npos) << text;
}

TEST(WorldsReport, JsonHasTheValuesBySeed) {
  const auto json = nlohmann::json::parse(
      to_json({outcome("park", 11, {0.5, 1.0}), outcome("park", 12, {0.75, 1.25}),
               without("park", 21, true)}));
  const auto& row = json["worlds"][0];
  EXPECT_EQ(row["role"], "choose");
  EXPECT_EQ(row["seeds"], (std::vector<int>{11, 12}));
  EXPECT_EQ(row["variants"][0]["ate_m"]["values"], (std::vector<double>{0.5, 0.75}));
  EXPECT_TRUE(row["variants"][0]["nees"]["mean"].is_null());
  EXPECT_EQ(row["differences"]["ate_m"]["mean"], 0.5);
  EXPECT_EQ(row["differences"]["ate_m"]["beyond_spread"], true);
  EXPECT_EQ(json["worlds"][1]["without"][0]["skipped"], true);
}

}  // namespace
}  // namespace lilo::worlds
