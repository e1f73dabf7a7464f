// SPDX-License-Identifier: BSD-3-Clause
#include "config/yaml_reader.hpp"

#include "config/scalar.hpp"
#include "config/suggest.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace lilo {
namespace {

// yaml-cpp marks quoted scalars with the tag "!", plain ones with "?".
bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  std::string out = text.substr(0, kLongest);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text.size() > kLongest ? out + "..." : out;
}

std::string describe(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return is_quoted(node) ? '"' + shortened(node.Scalar()) + '"' : shortened(node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a section";
    default:
      return "nothing";
  }
}

class Reader {
 public:
  Reader(const std::vector<Key>& keys, const std::vector<Section>& sections) : keys_(keys) {
    for (const Section& section : sections) section_paths_.push_back(section.path);
    known_ = section_paths_;
    for (const Key& key : keys) known_.push_back(key.path);
  }

  CheckedYaml read(const std::string& yaml) {
    try {
      const std::vector<YAML::Node> documents = YAML::LoadAll(yaml);
      if (documents.size() > 1) {
        add(documents[1].Mark(), "", "expected one YAML document, found a second one");
      } else if (documents.size() == 1 && !documents[0].IsNull()) {
        read_section(documents[0], "");
      }
    } catch (const YAML::Exception& error) {
      add(error.mark, "", "expected YAML, found: " + error.msg);
    }
    return std::move(result_);
  }

 private:
  void add(const YAML::Mark& mark, const std::string& key, std::string text) {
    result_.problems.push_back(
        {.line = mark.line + 1, .column = mark.column + 1, .key = key, .text = std::move(text)});
  }

  void read_section(const YAML::Node& map, const std::string& section) {
    if (map.IsNull()) return;  // a section whose keys are all commented out
    if (!map.IsMap()) {
      add(map.Mark(), section, "expected a section of `key: value` lines, found " + describe(map));
      return;
    }
    std::map<std::string, int> first_line;
    for (const auto& entry : map) {
      const YAML::Node& name = entry.first;
      if (!name.IsScalar()) {
        add(name.Mark(), section, "expected the name of a key, found " + describe(name));
        continue;
      }
      const std::string path = section.empty() ? name.Scalar() : section + '.' + name.Scalar();
      const auto [first, is_new] = first_line.emplace(path, name.Mark().line + 1);
      if (is_new) {
        read_entry(name, entry.second, path);
      } else {
        add(name.Mark(), path,
            fmt::format("expected each key once, found it again after line {}", first->second));
      }
    }
  }

  void read_entry(const YAML::Node& name, const YAML::Node& value, const std::string& path) {
    const auto key = std::find_if(keys_.begin(), keys_.end(),
                                  [&](const Key& candidate) { return candidate.path == path; });
    if (key != keys_.end()) {
      read_key(*key, value.IsNull() ? name : value, value);
    } else if (std::find(section_paths_.begin(), section_paths_.end(), path) !=
               section_paths_.end()) {
      read_section(value, path);
    } else {
      const std::string near = closest_path(path, known_);
      add(name.Mark(), shortened(path),
          "expected a known key, found \"" + shortened(name.Scalar()) + '"' +
              (near.empty() ? "" : "; did you mean " + near + '?'));
    }
  }

  void read_key(const Key& key, const YAML::Node& where, const YAML::Node& value) {
    if (key.type == KeyType::list) {
      read_list(key, value);
    } else if (const auto parsed = read_scalar(key, where, value)) {
      add_entry(key, *parsed, where.Mark());
    }
  }

  void add_entry(const Key& key, Value value, const YAML::Mark& mark) {
    result_.entries.push_back({&key, std::move(value), mark.line + 1, mark.column + 1});
  }

  void read_list(const Key& key, const YAML::Node& value) {
    if (!value.IsSequence()) {
      add(value.Mark(), key.path, "expected " + expected(key) + ", found " + describe(value));
      return;
    }
    std::vector<std::string> items;
    for (const YAML::Node& item : value) {
      const auto parsed = read_scalar(key, item, item);
      if (parsed) items.push_back(std::get<std::string>(*parsed));
    }
    if (items.size() == value.size()) add_entry(key, items, value.Mark());
  }

  std::optional<Value> read_scalar(const Key& key, const YAML::Node& where,
                                   const YAML::Node& value) {
    if (value.IsScalar()) {
      auto parsed = parse_scalar(key, value.Scalar(), is_quoted(value));
      if (parsed) return parsed;
    }
    std::string text = "expected " + expected(key) + ", found " + describe(value);
    if (value.IsScalar()) {
      const std::string odd = oddity(key, value.Scalar(), is_quoted(value));
      const std::string near =
          key.type == KeyType::choice ? closest_word(value.Scalar(), key.choices) : "";
      if (!odd.empty()) text += " (" + odd + ')';
      if (!near.empty()) text += "; did you mean " + near + '?';
    }
    add(where.Mark(), key.path, std::move(text));
    return std::nullopt;
  }

  const std::vector<Key>& keys_;
  std::vector<std::string> section_paths_;
  std::vector<std::string> known_;
  CheckedYaml result_;
};

}  // namespace

CheckedYaml read_yaml(const std::string& yaml, const std::vector<Key>& keys,
                      const std::vector<Section>& sections) {
  return Reader(keys, sections).read(yaml);
}

}  // namespace lilo
