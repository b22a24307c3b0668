# How the program, the module and the plugins resist errors in memory, added to talus_flags.
#
#   -z relro, -z now            tables of addresses are read-only once the program has been loaded
#   -z noexecstack              nothing on a stack is run
#   -fstack-protector-strong    a function that wrote beyond its arrays does not return
#   -fcf-protection             jumps and returns go where they may, on x86 processors that check it
#   -D_FORTIFY_SOURCE           the C library checks lengths; needs optimisation, and the sanitizers do it better
#
# What the compiler or linker does not know is left out. tests/python/test_hardening.py reads the files made.
include(CheckCCompilerFlag)
include(CheckCSourceCompiles)
include(CheckLinkerFlag)

foreach(flag -fstack-protector-strong -fcf-protection)
  string(MAKE_C_IDENTIFIER "has${flag}" has)
  check_c_compiler_flag(${flag} ${has})
  if(${has})
    target_compile_options(talus_flags INTERFACE ${flag})
  endif()
endforeach()

foreach(flag -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
  string(MAKE_C_IDENTIFIER "has${flag}" has)
  check_linker_flag(C ${flag} ${has})
  if(${has})
    target_link_options(talus_flags INTERFACE ${flag})
  endif()
endforeach()

# Level 3 also checks arrays whose length is known only at run time; C libraries without it warn.
if(NOT TALUS_SANITIZE)
  set(CMAKE_REQUIRED_FLAGS "-O2 -Werror -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3")
  check_c_source_compiles("#include <string.h>
    #if !defined(__USE_FORTIFY_LEVEL) || __USE_FORTIFY_LEVEL < 3
    #error level 3 is unknown
    #endif
    int main(int argc, char **argv) { char to[64]; memcpy(to, argv[0], 2); return to[argc]; }"
    has_fortify_3)
  unset(CMAKE_REQUIRED_FLAGS)
  set(level 2)
  if(has_fortify_3)
    set(level 3)
  endif()
  target_compile_options(talus_flags INTERFACE
    "$<$<NOT:$<CONFIG:Debug>>:SHELL:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=${level}>")
endif()
