// SPDX-License-Identifier: BSD-3-Clause
#include "config/suggest.hpp"

#include <algorithm>

namespace lilo {
namespace {

std::string_view last_part(std::string_view path) { return path.substr(path.rfind('.') + 1); }

std::string_view section_part(std::string_view path) {
  return path.substr(0, path.size() - last_part(path).size());
}

int tolerance(std::string_view word) { return std::max(1, static_cast<int>(word.size()) / 3); }

}  // namespace

// Optimal string alignment: Levenshtein's table with one more case, two neighbours swapped.
int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t n = b.size();
  std::vector<int> before(n + 1), above(n + 1), row(n + 1);
  for (std::size_t j = 0; j <= n; ++j) above[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= n; ++j) {
      const int replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[n];
}

std::string closest_word(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  int best_distance = tolerance(word) + 1;
  for (const std::string& candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::string closest_path(const std::string& path, const std::vector<std::string>& known) {
  const std::string_view name = last_part(path);
  std::string best;
  int best_score = 2 * tolerance(name) + 2;
  for (const std::string& candidate : known) {
    const bool elsewhere = section_part(candidate) != section_part(path);
    const int score = 2 * edit_distance(name, last_part(candidate)) + (elsewhere ? 1 : 0);
    if (score < best_score) {
      best_score = score;
      best = candidate;
    }
  }
  return best;
}

}  // namespace lilo
