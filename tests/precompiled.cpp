// Nothing: CMake needs a source to build the precompiled header beside.
