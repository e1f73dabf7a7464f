// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lilo {

/// What --version prints behind the program's name: "0.1.0 (Release, GNU 12.2.0, git 7442333)". A
/// revision with changes on top ends in "+"; without a repository there is none.
extern const char* const kVersionText;

}  // namespace lilo
