// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/finding.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace lilo::doctor {
namespace {

struct Look {
  const char* word;
  Colour colour;
};

Look look_of(Verdict verdict) {
  constexpr std::array<Look, 3> kLooks{
      {{"ok", Colour::good}, {"warn", Colour::warning}, {"FAIL", Colour::bad}}};
  return kLooks[static_cast<std::size_t>(verdict)];
}

}  // namespace

std::string to_text(const std::vector<Finding>& findings, const Paint& paint) {
  std::string text;
  for (const Finding& finding : findings) {
    const Look look = look_of(finding.verdict);
    text += fmt::format("{}  {:<14}  {}\n", paint(look.colour, fmt::format("{:<4}", look.word)),
                        finding.subject, finding.text);
    if (!finding.cure.empty()) text += fmt::format("{:22}-> {}\n", "", finding.cure);
  }
  return text;
}

std::string to_json(const std::vector<Finding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"verdict", look_of(finding.verdict).word},
                    {"subject", finding.subject},
                    {"text", finding.text},
                    {"cure", finding.cure}});
  }
  return nlohmann::json{{"ready", is_ready(findings)}, {"findings", list}}.dump() + "\n";
}

bool is_ready(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& finding) { return finding.verdict == Verdict::bad; });
}

}  // namespace lilo::doctor
