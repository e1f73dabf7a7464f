// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo {

/// lilo.bash and _lilo of this folder, built in.
extern const char* const kBashCompletion;
extern const char* const kZshCompletion;

}  // namespace lilo
