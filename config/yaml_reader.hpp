// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/key.hpp"

#include <string>
#include <vector>

namespace lilo {

/// One thing wrong with a file. Lines and columns count from 1; line 0: the file as a whole.
struct ConfigProblem {
  int line = 0, column = 0;
  std::string key;   ///< path, or empty
  std::string text;  ///< "expected ..., found ..."
};

/// One key of a file, of the right type and in its range.
struct ConfigEntry {
  const Key* key = nullptr;
  Value value;
  int line = 0, column = 0;  ///< of the value, from 1
};

/// What a YAML text says, checked against the table.
struct CheckedYaml {
  std::vector<ConfigEntry> entries;     ///< in the order of the file
  std::vector<ConfigProblem> problems;  ///< in the order of the file
};

/// Stricter than YAML where YAML surprises: unknown and repeated keys, octal-looking numbers, nan,
/// infinities, numbers in quotes and yes/no are problems. Never throws on what the text holds.
CheckedYaml read_yaml(const std::string& yaml, const std::vector<Key>& keys,
                      const std::vector<Section>& sections);

}  // namespace lilo
