// SPDX-License-Identifier: BSD-3-Clause
#include "tests/daemon/schema.hpp"

#include <algorithm>
#include <fstream>
#include <set>

namespace lilo {
namespace {

using nlohmann::json;

class Validator {
 public:
  explicit Validator(const json& root) : root_(root) {}

  void check(const json& schema, const json& value, const std::string& path) {
    for (const auto& [keyword, rule] : schema.items()) check_keyword(schema, keyword, value, path);
  }
  std::vector<std::string> found;

 private:
  void require(bool holds, const std::string& path, const std::string& what) {
    if (!holds) found.push_back(path + ": " + what);
  }

  static bool has_type(const json& value, const std::string& type) {
    if (type == "integer") return value.is_number_integer();
    if (type == "number") return value.is_number();
    return value.type_name() == type;
  }

  void check_keyword(const json& schema, const std::string& keyword, const json& value,
                     const std::string& path) {
    const json& rule = schema[keyword];
    if (keyword == "type") {
      require(has_type(value, rule), path, "expected " + rule.dump() + ", found " + value.dump());
    } else if (keyword == "enum") {
      require(std::find(rule.begin(), rule.end(), value) != rule.end(), path, value.dump());
    } else if (keyword == "minimum") {
      require(!value.is_number() || value >= rule, path, "below the minimum: " + value.dump());
    } else if (keyword == "maximum") {
      require(!value.is_number() || value <= rule, path, "above the maximum: " + value.dump());
    } else if (keyword == "minItems") {
      require(value.size() >= rule.get<std::size_t>(), path, "too few items");
    } else if (keyword == "maxItems") {
      require(value.size() <= rule.get<std::size_t>(), path, "too many items");
    } else if (keyword == "items") {
      for (const json& item : value) check(rule, item, path + "[]");
    } else if (keyword == "$ref") {
      check(root_["$defs"][rule.get<std::string>().substr(8)], value, path);
    } else {
      check_object_keyword(schema, keyword, value, path);
    }
  }

  void check_object_keyword(const json& schema, const std::string& keyword, const json& value,
                            const std::string& path) {
    static const std::set<std::string> notes{"$schema", "title", "$defs"};
    const json& rule = schema[keyword];
    if (keyword == "required") {
      for (const json& name : rule) require(value.contains(name), path, "no " + name.dump());
    } else if (keyword == "properties") {
      for (const auto& [name, sub] : rule.items()) {
        if (value.contains(name))
          check(sub, value[name], std::string(path).append("/").append(name));
      }
      // The schema allows them, for clients of an older version; we may not send them.
      for (const auto& [name, ignored] : value.items())
        require(rule.contains(name), path, "undocumented " + name);
    } else if (keyword == "oneOf") {
      const auto holds = std::count_if(rule.begin(), rule.end(), [&](const json& option) {
        Validator one(root_);
        one.check(option, value, path);
        return one.found.empty();
      });
      require(holds == 1, path, std::to_string(holds) + " kinds at once");
    } else {
      require(notes.contains(keyword), path, "the validator does not know " + keyword);
    }
  }

  const json& root_;
};

}  // namespace

std::vector<std::string> violations(const json& schema, const json& value) {
  Validator validator(schema);
  validator.check(schema, value, "");
  return validator.found;
}

json protocol_schema() { return json::parse(std::ifstream(LILO_SCHEMA_FILE)); }

}  // namespace lilo
