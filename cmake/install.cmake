# What `cmake --install` puts under the prefix, all of it found relative to itself:
#
#   bin/talus                          the program
#   lib/libtalus.so.*, libtalus.a      the kernel as a library
#   lib/lua/5.4/talus.so               the module for a stock Lua
#   lib/talus/plugins-ABI/*.so         the plugins
#   lib/cmake/talus, lib/pkgconfig     for those who build upon it
#   include/talus, share/talus         headers; examples, templates
#   share/doc/talus, share/man         pages, talus(1)
#
# The folder is lib everywhere, not lib64 or one of the architecture's name: the loader of plugins seeks from the program, the
# module and the library (core/plugin/loader.c).
include(CMakePackageConfigHelpers)

set(TALUS_PLUGIN_DIR lib/talus/plugins-${TALUS_ABI})
set(TALUS_PROGRAM bin/talus)
set(config_dir lib/cmake/talus)

install(TARGETS talus_shared talus_headers EXPORT talusTargets
  LIBRARY DESTINATION lib FILE_SET headers DESTINATION include)
install(TARGETS talus_kernel ARCHIVE DESTINATION lib)
install(EXPORT talusTargets NAMESPACE talus:: DESTINATION ${config_dir})

configure_package_config_file(cmake/talusConfig.cmake.in "${PROJECT_BINARY_DIR}/talusConfig.cmake"
  INSTALL_DESTINATION ${config_dir} PATH_VARS TALUS_PLUGIN_DIR TALUS_PROGRAM)
# While the major version is 0, a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/talusConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
configure_file(cmake/talus.pc.in "${PROJECT_BINARY_DIR}/talus.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/talusConfig.cmake" "${PROJECT_BINARY_DIR}/talusConfigVersion.cmake"
  cmake/talus_add_plugin.cmake DESTINATION ${config_dir})
install(FILES "${PROJECT_BINARY_DIR}/talus.pc" DESTINATION lib/pkgconfig)

install(DIRECTORY scripts/examples scripts/meta scripts/paraview DESTINATION share/talus) # meta: for editors
install(DIRECTORY plugins/template/ DESTINATION share/talus/templates)

# The pages lie as they do in the source tree, so their links hold.
set(doc_dir share/doc/talus)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md LICENSE DESTINATION ${doc_dir})
install(FILES LICENSE DESTINATION ${doc_dir} RENAME copyright) # where Debian looks for it
install(DIRECTORY docs DESTINATION ${doc_dir} PATTERN "*.in" EXCLUDE)
install(CODE "set(to \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${doc_dir}/scripts\")
  file(MAKE_DIRECTORY \"\${to}\")
  file(REMOVE \"\${to}/examples\")
  file(CREATE_LINK ../../../talus/examples \"\${to}/examples\" SYMBOLIC)")
configure_file(docs/talus.1.in "${PROJECT_BINARY_DIR}/talus.1" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/talus.1" DESTINATION share/man/man1)
