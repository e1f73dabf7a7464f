// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/terminal/paint.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lilo::doctor {

enum class Verdict : std::uint8_t { good, warning, bad };

/// One thing that was looked at.
struct Finding {
  Verdict verdict = Verdict::good;
  std::string subject;  ///< "Clock"
  std::string text;     ///< what was found
  std::string cure;     ///< what to do about it; empty: nothing
};

std::string to_text(const std::vector<Finding>& findings, const Paint& paint);
std::string to_json(const std::vector<Finding>& findings);
/// True when a drive can begin: nothing is bad.
bool is_ready(const std::vector<Finding>& findings);

}  // namespace lilo::doctor
