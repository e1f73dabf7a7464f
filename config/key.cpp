// SPDX-License-Identifier: BSD-3-Clause
#include "config/key.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace lilo {

std::string expected(const Key& key) {
  const std::string unit = key.unit.empty() ? "" : " (" + key.unit + ")";
  switch (key.type) {
    case KeyType::boolean:
      return "true or false";
    case KeyType::integer:
      return fmt::format("a whole number from {:.10g} to {:.10g}{}", key.min, key.max, unit);
    case KeyType::real:
      return fmt::format("a number from {:.10g} to {:.10g}{}", key.min, key.max, unit);
    case KeyType::text:
      return std::string(key.form.name);
    case KeyType::choice:
      return fmt::format("one of {}", fmt::join(key.choices, ", "));
    case KeyType::list:
      return fmt::format("a list, each item {}", key.form.name);
  }
  return {};
}

std::vector<const Key*> differing_keys(const std::vector<Key>& keys, const Config& a,
                                       const Config& b) {
  std::vector<const Key*> differing;
  for (const Key& key : keys) {
    if (key.get(a) != key.get(b)) differing.push_back(&key);
  }
  return differing;
}

}  // namespace lilo
