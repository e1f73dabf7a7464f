// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace lilo::view {

/// A file of the page, built in.
struct PageFile {
  std::string_view name;  ///< as in the URL, without the slash
  std::string_view type;  ///< MIME
  std::string_view text;
};

std::span<const PageFile> page_files();
/// nullptr: there is none of that name. The empty name is that of the page itself.
const PageFile* find_page_file(std::string_view name);

}  // namespace lilo::view
