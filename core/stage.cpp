// SPDX-License-Identifier: BSD-3-Clause
#include "core/stage.hpp"

namespace lilo {

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::project:
      return "project";
    case Stage::filter:
      return "filter";
    case Stage::reconstruct:
      return "reconstruct";
    case Stage::deskew:
      return "deskew";
    case Stage::align:
      return "align";
    case Stage::update_map:
      return "update_map";
  }
  return "unknown";
}

}  // namespace lilo
