// SPDX-License-Identifier: BSD-3-Clause
#include "config/text_forms.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <charconv>
#include <string>

namespace lilo {
namespace {

bool is_port(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), port);
  return error == std::errc{} && end == text.end() && port >= 1 && port <= 65535;
}

}  // namespace

bool is_address(std::string_view text) {
  in_addr parsed{};
  return inet_pton(AF_INET, std::string(text).c_str(), &parsed) == 1;
}

bool is_any_address(std::string_view text) {
  in6_addr parsed{};
  return is_address(text) || inet_pton(AF_INET6, std::string(text).c_str(), &parsed) == 1;
}

bool is_address_range(std::string_view text) {
  const std::size_t slash = text.find('/');
  const std::string_view address = text.substr(0, slash);
  if (!is_any_address(address)) return false;
  if (slash == std::string_view::npos) return true;
  const std::string_view digits = text.substr(slash + 1);
  int bits = -1;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), bits);
  return error == std::errc{} && end == digits.end() && bits >= 0 &&
         bits <= (is_address(address) ? 32 : 128);
}

bool is_address_or_empty(std::string_view text) { return text.empty() || is_address(text); }

bool is_endpoint(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return false;
  const std::string_view host = text.substr(0, colon);
  return (host == "localhost" || is_address(host)) && is_port(text.substr(colon + 1));
}

bool is_frame_name(std::string_view text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./").find(c) != std::string_view::npos;
  };
  return !text.empty() && text.size() <= 64 && std::all_of(text.begin(), text.end(), allowed);
}

bool is_path(std::string_view text) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
  return text.size() < 4096 && std::none_of(text.begin(), text.end(), control);
}

}  // namespace lilo
