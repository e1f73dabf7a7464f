# Writes version.cpp anew when the revision is another: cmake -D SOURCE= -D OUT= ... -P this
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty=+ --abbrev=9 --exclude=*
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR revision STREQUAL "")
  set(LILO_REVISION "")
else()
  set(LILO_REVISION ", git ${revision}")
endif()
configure_file(${SOURCE}/config/version.cpp.in ${OUT} @ONLY)
