// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "config/value.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lilo {

enum class KeyType : std::uint8_t { boolean, integer, real, text, choice, list };

/// Whether a running daemon takes a new value on SIGHUP, or only the next start does.
enum class Reload : std::uint8_t { live, restart };

/// What a text, or each item of a list, must look like.
struct TextForm {
  std::string_view name;  ///< as in "expected <name>"
  bool (*valid)(std::string_view) = nullptr;
};

/// All there is to know about one key of the YAML file. Reading, checking, `--print-config` and
/// the reference are made from a table of these and from nothing else.
struct Key {
  std::string path;  ///< "section.key"
  KeyType type = KeyType::text;
  std::string unit;                  ///< of the number in the file; empty: none
  double min = 0.0, max = 0.0;       ///< integer and real, both ends allowed
  std::vector<std::string> choices;  ///< choice
  TextForm form;                     ///< text and list
  Reload reload = Reload::restart;
  std::string meaning;  ///< one or two sentences
  std::function<Value(const Config&)> get;
  std::function<void(Config&, const Value&)> set;  ///< takes what get() gives
};

/// A part of the file and what it is about, in the order of the file.
struct Section {
  std::string path;
  std::string meaning;
};

/// The table. Keys of one section stand together.
std::vector<Key> config_keys();
std::vector<Section> config_sections();

/// "a number from 1 to 200 (m)", "one of auto, vlp16, hdl64e": for errors and for the reference.
std::string expected(const Key& key);

/// Paths of the keys in which the two differ.
std::vector<const Key*> differing_keys(const std::vector<Key>& keys, const Config& a,
                                       const Config& b);

}  // namespace lilo
