#pragma once

#include <cstdint>
#include <string>

namespace lilo {

/// A bar on the terminal's error stream; nothing at all where that is no terminal.
class ProgressBar {
 public:
  ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< takes the bar away

  /// True ten times a second: then show() is worth its while.
  [[nodiscard]] bool due() const;
  /// `part` in [0, 1]; `note` stands behind the bar.
  void show(double part, const std::string& note);

 private:
  bool visible_;
  std::int64_t next_ns_ = 0;
};

/// The bar's text, `width` characters between the brackets.
std::string progress_text(double part, int width);

}  // namespace lilo
