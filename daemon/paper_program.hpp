// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lilo {

/// Goes on as the program that has profile paper, with the same arguments. Returns why it cannot,
/// in one line.
std::string become_paper_program(char** argv);

}  // namespace lilo
