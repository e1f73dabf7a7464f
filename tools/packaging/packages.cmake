# Four Debian packages by CPack, read with LILO_PACKAGE=ON; tools/package builds them.

# No mailbox yet: .invalid is nobody's (RFC 2606). Who publishes the packages sets DEBFULLNAME and
# DEBEMAIL for tools/package.
set(LILO_MAINTAINER "lilod maintainers <maintainers@lilod.invalid>" CACHE STRING "Whom packages name")
set(LILO_HOMEPAGE "" CACHE STRING "Where the project lives; packages name it when it is set")

install(DIRECTORY ${manuals}/lilod/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT lilod OPTIONAL)
install(DIRECTORY ${manuals}/lilo-tools/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT lilo-tools
  OPTIONAL)
foreach(sensor vlp16 vlp32c hdl32e hdl64e vls128)
  install(FILES ${PROJECT_SOURCE_DIR}/config/${sensor}.yaml DESTINATION /etc/lilod COMPONENT lilod)
endforeach()
foreach(package lilod lilo-tools lilod-dev python3-lilo)
  install(FILES debian/copyright ${CMAKE_BINARY_DIR}/changelog.gz DESTINATION ${doc}/${package}
    COMPONENT ${package})
endforeach()
install(FILES debian/lilod.lintian-overrides DESTINATION share/lintian/overrides RENAME lilod COMPONENT lilod)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL lilod lilo-tools lilod-dev python3-lilo) # alone: nothing that has no component
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${LILO_MAINTAINER})
if(LILO_HOMEPAGE)
  set(CPACK_DEBIAN_PACKAGE_HOMEPAGE ${LILO_HOMEPAGE})
endif()
# Two builds give the same bytes: every file is as old as the changelog's newest entry.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_SOURCE_DIR}/set_times.cmake)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # Depends: what is linked, by dpkg-shlibdeps

set(CPACK_DEBIAN_LILOD_PACKAGE_NAME lilod)
set(CPACK_DEBIAN_LILOD_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LILOD_DESCRIPTION "LiDAR odometry daemon for Velodyne sensors
 Listens to a rotating Velodyne LiDAR on its Ethernet port and sends where
 the sensor is, in real time, as JSON datagrams over UDP. Needs neither ROS nor
 a GPU nor an IMU.")
set(CPACK_DEBIAN_LILOD_PACKAGE_SUGGESTS lilo-tools)
set(CPACK_DEBIAN_LILOD_PACKAGE_CONTROL_EXTRA
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/conffiles ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm ${CMAKE_CURRENT_SOURCE_DIR}/debian/postrm)

set(CPACK_DEBIAN_LILO-TOOLS_PACKAGE_NAME lilo-tools)
set(CPACK_DEBIAN_LILO-TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_LILO-TOOLS_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_LILO-TOOLS_PACKAGE_SUGGESTS lilod)
set(CPACK_DEBIAN_LILO-TOOLS_DESCRIPTION "toolbox for LiDAR odometry with lilod
 Runs LiDAR odometry on recordings, simulates drives with exact truth, plays
 captures to the daemon lilod, prints the poses it sends, measures errors and
 draws maps.")

set(CPACK_DEBIAN_LILOD-DEV_PACKAGE_NAME lilod-dev)
set(CPACK_DEBIAN_LILOD-DEV_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_LILOD-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LILOD-DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_LILOD-DEV_DESCRIPTION "client of the LiDAR odometry daemon lilod
 A C++ header that receives the poses lilod sends, examples in C++ and in
 Python, and the ROS 2 package lilo_ros.")
set(CPACK_DEBIAN_LILOD-DEV_PACKAGE_SUGGESTS python3-lilo)

set(CPACK_DEBIAN_PYTHON3-LILO_PACKAGE_NAME python3-lilo)
set(CPACK_DEBIAN_PYTHON3-LILO_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON3-LILO_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON3-LILO_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_PYTHON3-LILO_PACKAGE_DEPENDS "python3 (>= 3.9)")
set(CPACK_DEBIAN_PYTHON3-LILO_DESCRIPTION "Python client of the LiDAR odometry daemon lilod
 The module lilo_client: poses and health from lilod as dictionaries, and
 requests to it. It needs nothing but Python.")
include(CPack)
