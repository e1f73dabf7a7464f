// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/key.hpp"

#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

// The member of Config that a key sets. (The name of a member cannot stand in parentheses.)
#define LILO_MEMBER(name) \
  [](Config & c) -> auto& { return c.name; }  // NOLINT

/// One function per kind of key, so that a key is one line of the table. `member` is a function
/// that takes a Config& and returns a reference to the member the key sets.
namespace lilo::key_builders {

template <typename Member>
using MemberType = std::remove_reference_t<std::invoke_result_t<Member, Config&>>;

/// The members are read through the same function that writes them; get() does not change.
template <typename Member>
const MemberType<Member>& read(Member member, const Config& config) {
  return member(const_cast<Config&>(config));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

template <typename Member>
Key boolean(const std::string& path, Member member, Reload reload, const std::string& meaning) {
  return {.path = path,
          .type = KeyType::boolean,
          .reload = reload,
          .meaning = meaning,
          .get = [member](const Config& c) { return Value(read(member, c)); },
          .set = [member](Config& c, const Value& v) { member(c) = std::get<bool>(v); }};
}

template <typename Member>
Key integer(const std::string& path, Member member, double min, double max, const std::string& unit,
            Reload reload, const std::string& meaning) {
  using T = MemberType<Member>;
  return {
      .path = path,
      .type = KeyType::integer,
      .unit = unit,
      .min = min,
      .max = max,
      .reload = reload,
      .meaning = meaning,
      .get = [member](const Config& c) { return Value(std::int64_t{read(member, c)}); },
      .set = [member](Config& c,
                      const Value& v) { member(c) = static_cast<T>(std::get<std::int64_t>(v)); }};
}

/// `scale`: the member's unit in the file's unit, e.g. radians per degree.
template <typename Member>
Key real(const std::string& path, Member member, double min, double max, const std::string& unit,
         Reload reload, const std::string& meaning, double scale = 1.0) {
  using T = MemberType<Member>;
  return {
      .path = path,
      .type = KeyType::real,
      .unit = unit,
      .min = min,
      .max = max,
      .reload = reload,
      .meaning = meaning,
      .get = [member, scale](
                 const Config& c) { return Value(static_cast<double>(read(member, c)) / scale); },
      .set = [member, scale](
                 Config& c,
                 const Value& v) { member(c) = static_cast<T>(std::get<double>(v) * scale); }};
}

/// Degrees in the file, radians in the struct.
template <typename Member>
Key angle(const std::string& path, Member member, double min_deg, double max_deg, Reload reload,
          const std::string& meaning) {
  return real(path, member, min_deg, max_deg, "deg", reload, meaning, std::numbers::pi / 180.0);
}

/// `names`: those of the enumeration's values 0, 1, 2, ...
template <typename Member>
Key choice(const std::string& path, Member member, const std::vector<std::string>& names,
           Reload reload, const std::string& meaning) {
  using T = MemberType<Member>;
  return {.path = path,
          .type = KeyType::choice,
          .choices = names,
          .reload = reload,
          .meaning = meaning,
          .get =
              [member, names](const Config& c) {
                return Value(names.at(static_cast<std::size_t>(read(member, c))));
              },
          .set =
              [member, names](Config& c, const Value& v) {
                std::size_t k = 0;
                while (k + 1 < names.size() && names[k] != std::get<std::string>(v)) ++k;
                member(c) = static_cast<T>(k);
              }};
}

template <typename Member>
Key text(const std::string& path, Member member, TextForm form, Reload reload,
         const std::string& meaning) {
  return {.path = path,
          .type = KeyType::text,
          .form = form,
          .reload = reload,
          .meaning = meaning,
          .get = [member](const Config& c) { return Value(read(member, c)); },
          .set = [member](Config& c, const Value& v) { member(c) = std::get<std::string>(v); }};
}

template <typename Member>
Key list(const std::string& path, Member member, TextForm form, Reload reload,
         const std::string& meaning) {
  return {.path = path,
          .type = KeyType::list,
          .form = form,
          .reload = reload,
          .meaning = meaning,
          .get = [member](const Config& c) { return Value(read(member, c)); },
          .set = [member](Config& c,
                          const Value& v) { member(c) = std::get<std::vector<std::string>>(v); }};
}

}  // namespace lilo::key_builders
