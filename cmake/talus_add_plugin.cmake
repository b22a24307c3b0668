# talus_add_plugin(NAME SOURCE...): a plugin of Talus, the module NAME.so, of C files.
#
# It sees Talus's headers and links the mathematics library only. Its symbols are hidden but for tl_plugin_entry, which the
# headers export. -ffp-contract=off and no vectorising of straight-line code by gcc keep the bits the same for
# every compiler and vector width; the other options let loops over columns become vectors (`#pragma omp simd`).
function(talus_add_plugin name)
  if(NOT ARGN)
    message(FATAL_ERROR "talus_add_plugin(${name}): give its C files after the name")
  endif()
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE talus::headers m)
  target_compile_options(${name} PRIVATE
    -ffp-contract=off -fno-math-errno -fno-trapping-math -fopenmp-simd
    $<$<C_COMPILER_ID:GNU>:-fno-tree-slp-vectorize> $<$<CONFIG:Release>:-O3>)
  set_target_properties(${name} PROPERTIES
    PREFIX "" SUFFIX ".so" C_STANDARD 17 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF C_VISIBILITY_PRESET hidden)
endfunction()
