// SPDX-License-Identifier: BSD-3-Clause
#include "tools/view/access.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

namespace lilo::view {
namespace {

constexpr std::string_view kCookie = "lilo_view=";
// A link that nobody opened is forgotten when so many came after it.
constexpr std::size_t kMostKeys = 64;

std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']') + 1;
    return end == host.size() || host.substr(end).starts_with(':') ? host.substr(0, end) : host;
  }
  return host.substr(0, host.find(':'));
}

/// The value of our cookie in a Cookie header; empty: none.
std::string_view cookie_in(std::string_view cookies) {
  const std::size_t at = cookies.find(kCookie);
  if (at == std::string_view::npos) return {};
  const std::string_view value = cookies.substr(at + kCookie.size());
  return value.substr(0, value.find(';'));
}

}  // namespace

std::string new_secret() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", device(), device(), device(), device());
}

bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned differing = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    differing |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]);
  return differing == 0;
}

std::string Access::new_key() {
  if (keys_.size() >= kMostKeys) keys_.clear();
  return *keys_.insert(new_secret()).first;
}

std::string Access::redeem(std::string_view key) {
  const auto found = keys_.find(key);
  if (found == keys_.end()) return {};
  keys_.erase(found);
  return *cookies_.insert(new_secret()).first;
}

bool Access::may_read(std::string_view host, std::string_view cookies, std::string_view key) const {
  if (links_needed_) {
    return cookies_.contains(cookie_in(cookies)) || is_same_secret(key, lasting_key_);
  }
  // A name that someone else made point here is not ours: his page would be of our own origin.
  constexpr std::array<std::string_view, 3> kOurs{"localhost", "127.0.0.1", "[::1]"};
  return std::find(kOurs.begin(), kOurs.end(), without_port(host)) != kOurs.end();
}

bool Access::is_origin_good(std::string_view origin, std::string_view host) const {
  if (origin.empty()) return true;
  if (origin == "http://" + std::string(host)) return true;
  return std::find(origins_.begin(), origins_.end(), origin) != origins_.end();
}

}  // namespace lilo::view
