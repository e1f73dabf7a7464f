// SPDX-License-Identifier: BSD-3-Clause
#include "tools/terminal/paint.hpp"
#include "tools/terminal/printable.hpp"
#include "tools/terminal/progress_bar.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

namespace lilo {
namespace {

TEST(ProgressBar, FillsFromLeftToRight) {
  EXPECT_EQ(progress_text({0.5, 0, "x"}, 0.0, 0.1, 16), "[##..]  50 %  x");
  EXPECT_EQ(progress_text({1.2, 0, "x"}, 0.0, 0.1, 16), "[####] 100 %  x");
}

TEST(ProgressBar, SaysTheTimeLeftAndTheRateOnceItIsKnown) {
  const std::string line = progress_text({0.25, 400, "scans"}, 0.0, 10.0, 200);
  EXPECT_EQ(line.substr(line.find(']')), "]  25 %  30 s left  400 scans, 40/s");
  EXPECT_EQ(progress_text({0.25, 400, "scans"}, 0.0, 0.5, 200).find("left"), std::string::npos);
}

// Work that goes on where it was stopped: half was there, a quarter took 10 s, so a quarter more.
TEST(ProgressBar, CountsTimeFromWhereItBegan) {
  const std::string line = progress_text({0.75, 0, ""}, 0.5, 10.0, 200);
  EXPECT_NE(line.find("10 s left"), std::string::npos) << line;
}

TEST(ProgressBar, LongTimesAreInMinutesAndHours) {
  EXPECT_NE(progress_text({0.5, 0, ""}, 0.0, 125.0, 200).find("2:05 min left"), std::string::npos);
  EXPECT_NE(progress_text({0.5, 0, ""}, 0.0, 7500.0, 200).find("2:05 h left"), std::string::npos);
}

TEST(ProgressBar, WithoutAnEndThereIsNoBar) {
  EXPECT_EQ(progress_text({0.0, 50, "packets"}, 0.0, 10.0, 80), "50 packets, 5/s");
}

TEST(ProgressBar, NeverFillsALineToItsEnd) {
  for (const std::size_t columns : {0U, 1U, 5U, 12U, 40U, 80U, 200U}) {
    const std::string line =
        progress_text({0.5, 123456, "scans of a long name"}, 0.0, 60.0, columns);
    EXPECT_LT(line.size(), std::max<std::size_t>(columns, 1)) << columns;
  }
}

TEST(Paint, ColoursOnlyWhenOn) {
  EXPECT_EQ(Paint(false)(Colour::bad, "lost"), "lost");
  EXPECT_EQ(Paint(true)(Colour::bad, "lost"), "\033[31mlost\033[0m");
  EXPECT_EQ(Paint(true)(Colour::none, "plain"), "plain");
}

/// A pseudo terminal's descriptor.
class Terminal {
 public:
  Terminal() : fd_(posix_openpt(O_RDWR | O_NOCTTY)) {
    grantpt(fd_);
    unlockpt(fd_);
  }
  ~Terminal() { close(fd_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  [[nodiscard]] int descriptor() const { return fd_; }

 private:
  int fd_;
};

// ECMA-48: C0 and C1 are what terminals obey; C1 is U+0080 to U+009F, two bytes in UTF-8.
TEST(Printable, LeavesNothingThatATerminalObeys) {
  EXPECT_EQ(printable("tracking 10 Hz"), "tracking 10 Hz");
  EXPECT_EQ(printable("\x1b]0;title\x07\r\n\x7f"), "?]0;title????");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "2J"),
            "a?2J");
  EXPECT_EQ(printable("\u2581\u00b5"), "\u2581\u00b5") << "bars and letters stay";
  EXPECT_EQ(printable(std::string_view("\0\xc2", 2)), "?\xc2");
}

TEST(Paint, NoColorIsHonoured) {
  const Terminal terminal;
  setenv("TERM", "xterm", 1);
  unsetenv("NO_COLOR");
  EXPECT_NE(Paint(terminal.descriptor())(Colour::good, "x"), "x");
  setenv("NO_COLOR", "1", 1);
  EXPECT_EQ(Paint(terminal.descriptor())(Colour::good, "x"), "x");
  unsetenv("NO_COLOR");
  setenv("TERM", "dumb", 1);
  EXPECT_EQ(Paint(terminal.descriptor())(Colour::good, "x"), "x");
}

}  // namespace
}  // namespace lilo
