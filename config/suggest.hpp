// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lilo {

/// Edits (insert, delete, replace, swap neighbours) that turn one word into the other.
int edit_distance(std::string_view a, std::string_view b);

/// The known path that `path` was probably meant to be, or nothing when none is near: a key of the
/// same name in another section, or a name at most a third of its letters away.
std::string closest_path(const std::string& path, const std::vector<std::string>& known);

/// The known word nearest to `word` by the same measure.
std::string closest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace lilo
