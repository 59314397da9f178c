# SPDX-License-Identifier: Apache-2.0
# Debian packages of what RdsInstall.cmake installs: rds-slam (services), rds-slam-tools (rds), librds-slam-dev.
#   cpack --preset release      writes them into build/release/packages
set(RDS_PACKAGE_CONTACT "RDS-SLAM developers <rds-slam@packages.invalid>" CACHE STRING "Maintainer of the packages: Name <address>")

# As dpkg wants them: a changelog of a native package, and copyrights, in each package's folder of documents.
function(_rds_install_package_documents component package)
  set(out ${CMAKE_BINARY_DIR}/install/${package})
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH, where it is set
  file(WRITE ${out}/changelog
    "rds-slam (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * See CHANGELOG.md of the sources.\n\n -- ${RDS_PACKAGE_CONTACT}  ${date}\n")
  execute_process(COMMAND gzip -9nf ${out}/changelog COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${out}/changelog.gz ${PROJECT_SOURCE_DIR}/cmake/packages/copyright DESTINATION share/doc/${package} COMPONENT ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/packages/${package}.lintian-overrides DESTINATION share/lintian/overrides RENAME ${package}
    COMPONENT ${component} OPTIONAL)
endfunction()
_rds_install_package_documents(services rds-slam)
_rds_install_package_documents(tools rds-slam-tools)
_rds_install_package_documents(dev librds-slam-dev)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME rds-slam)
set(CPACK_PACKAGE_CONTACT "${RDS_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_VENDOR RDS-SLAM)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL services tools dev)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib/openvino)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_SERVICES_PACKAGE_NAME rds-slam)
set(CPACK_DEBIAN_SERVICES_PACKAGE_SECTION science)
set(CPACK_DEBIAN_SERVICES_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SERVICES_PACKAGE_SUGGESTS rds-slam-tools)
set(CPACK_DEBIAN_SERVICES_DESCRIPTION "real-time semantic mapping among moving people: services
Localises an RGB-D camera, ignores what moves, and keeps a semantic octree map
that any other program can subscribe to over DDS. These are the services
(tracker, detector, transformer, mapper, loop closer, viewer) with their
systemd units and, as private libraries, OpenVINO's runtime for the detector.
The detector's network is not part of it: rds models fetch, of rds-slam-tools,
brings one.")
set(CPACK_DEBIAN_SERVICES_PACKAGE_CONTROL_EXTRA
  ${PROJECT_SOURCE_DIR}/cmake/packages/postinst ${PROJECT_SOURCE_DIR}/cmake/packages/prerm ${PROJECT_SOURCE_DIR}/cmake/packages/postrm)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME rds-slam-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS "rds-slam (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "npm, python3-numpy")
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "real-time semantic mapping among moving people: command line
The program rds: run the services on a recording, record and play topics,
evaluate results, look at live and saved maps, render recordings of a room
with people, check recordings and this machine.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME librds-slam-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "cyclonedds-dev, libboost-dev, libcli11-dev, libeigen3-dev, libexpected-dev, libfastcdr-dev, libfastrtps-dev, libfmt-dev, liboctomap-dev, libopencv-dev, libspdlog-dev, libsqlite3-dev, libssl-dev, libsystemd-dev, libyaml-cpp-dev, libzstd-dev, nlohmann-json3-dev, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION "real-time semantic mapping among moving people: reader's library
For C++ programs that read the live map: a copy that is kept up to date, the
messages, and a bus over two vendors of DDS, as static libraries that
find_package(rds) finds; the messages' definitions for ROS 2; examples.")

include(CPack)
