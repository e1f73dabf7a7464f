// SPDX-License-Identifier: BSD-3-Clause
// Nothing: CMake needs a source to build the precompiled header beside.
