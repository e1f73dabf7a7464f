// SPDX-License-Identifier: BSD-3-Clause
/// Read by ThreadSanitizer at the start, and by nobody else: libOpenNI2, which PCL's io library
/// brings along, unlocks mutexes that it did not lock when the program ends.
extern "C" const char* __tsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "mutex:libOpenNI2.so\n";
}
