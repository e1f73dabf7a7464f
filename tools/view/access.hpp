// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lilo::view {

/// 128 bits of the system's randomness, in hexadecimal digits.
std::string new_secret();

/// Compares without telling by its time how much was right.
bool is_same_secret(std::string_view a, std::string_view b);

/// Who may look on.
///
/// On loopback everybody of this computer may, but no page of another site: a browser names the
/// site of a page in Origin, and the site it believes to talk to in Host. Beyond loopback a link is
/// needed that works once, and gives the browser a cookie for the time the view runs.
class Access {
 public:
  /// `beyond_loopback`: links are needed. `origins`: sites whose pages may connect, too.
  Access(bool beyond_loopback, std::vector<std::string> origins)
      : links_needed_(beyond_loopback), origins_(std::move(origins)) {}

  [[nodiscard]] bool links_needed() const { return links_needed_; }

  /// A key for one link.
  std::string new_key();
  /// The cookie for the key of a link, which is used up by it; empty: the key is none.
  std::string redeem(std::string_view key);
  /// For programs that keep no cookies: a key that stays good.
  [[nodiscard]] const std::string& lasting_key() const { return lasting_key_; }

  /// Whether a request may have the page: its Host is one of ours, or it brings a cookie.
  [[nodiscard]] bool may_read(std::string_view host, std::string_view cookies,
                              std::string_view key) const;
  /// Whether a page of `origin` (empty: no browser) may open a stream.
  [[nodiscard]] bool is_origin_good(std::string_view origin, std::string_view host) const;

 private:
  bool links_needed_;
  std::vector<std::string> origins_;
  std::string lasting_key_ = new_secret();
  std::set<std::string, std::less<>> keys_, cookies_;
};

}  // namespace lilo::view
