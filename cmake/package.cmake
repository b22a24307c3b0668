# Packages: `cpack -G DEB` or `cpack -G TGZ` in a build folder. Debian's tools find out which libraries a .deb depends on.
set(CPACK_PACKAGE_NAME talus)
set(CPACK_PACKAGE_VENDOR "The Talus authors")
set(CPACK_PACKAGE_CONTACT "The Talus authors <noreply@talus.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
  "Talus computes how jointed rock moves: rigid convex blocks that touch, slide, rock and fall. With the program, the module for
 Lua 5.4, the library with its headers, the plugins, examples and documentation.")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR TGZ DEB)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Who links libtalus.so depends on this package; the system's list of libraries is renewed after unpacking it.
file(CONFIGURE OUTPUT debian/shlibs
  CONTENT "libtalus @PROJECT_VERSION_MAJOR@.@PROJECT_VERSION_MINOR@ talus (>= @PROJECT_VERSION@)\n" @ONLY)
file(CONFIGURE OUTPUT debian/triggers CONTENT "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  "${PROJECT_BINARY_DIR}/debian/shlibs" "${PROJECT_BINARY_DIR}/debian/triggers")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "lua5.4, paraview, cmake, pkg-config, gcc")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
