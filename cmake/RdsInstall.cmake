# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where; the components are the packages of RdsPackages.cmake.
#
# Programs lie in lib/rds-slam/bin, with links in bin: what they look for beside themselves (each other, ../lib/openvino,
# ../lib/librds_zenoh.so, ../share/rds-slam) is then in a folder of their own.
set(RDS_PRIVATE lib/rds-slam)
set(RDS_DEV_LIB lib/${CMAKE_LIBRARY_ARCHITECTURE})
set(RDS_SERVICES rds-tracker rds-detector rds-transformer rds-mapper rds-loop-closer rds-viewer)

# A link as it will be, whatever the prefix.
function(_rds_install_link target name folder component)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/install/${folder})
  file(CREATE_LINK ${target} ${CMAKE_BINARY_DIR}/install/${folder}/${name} SYMBOLIC)
  install(FILES ${CMAKE_BINARY_DIR}/install/${folder}/${name} DESTINATION ${folder} COMPONENT ${component})
endfunction()

# Manual page and completions, written by the program itself from its CLI11 definitions (common/command_line).
function(_rds_install_documents program component)
  set(out ${CMAKE_BINARY_DIR}/install/documents)
  set(files ${out}/${program}.1.gz ${out}/${program}.bash ${out}/_${program})
  set(write $<TARGET_FILE:${program}> --document)
  add_custom_command(OUTPUT ${files}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${out}
    COMMAND sh -c "\"$1\" --document man | gzip -9n >\"$2\"" sh $<TARGET_FILE:${program}> ${out}/${program}.1.gz
    COMMAND ${write} bash > ${out}/${program}.bash
    COMMAND ${write} zsh > ${out}/_${program}
    DEPENDS ${program} COMMENT "Manual page and completions of ${program}" VERBATIM)
  set_property(GLOBAL APPEND PROPERTY RDS_DOCUMENTS ${files})
  install(FILES ${out}/${program}.1.gz DESTINATION share/man/man1 COMPONENT ${component})
  install(FILES ${out}/${program}.bash DESTINATION share/bash-completion/completions RENAME ${program} COMPONENT ${component})
  install(FILES ${out}/_${program} DESTINATION share/zsh/vendor-completions COMPONENT ${component})
endfunction()

function(_rds_install_program program component)
  install(TARGETS ${program} DESTINATION ${RDS_PRIVATE}/bin COMPONENT ${component})
  _rds_install_link(../lib/rds-slam/bin/${program} ${program} bin ${component})
  if(NOT RDS_SANITIZE)
    _rds_install_documents(${program} ${component})
  endif()
endfunction()

# --- services
foreach(service IN LISTS RDS_SERVICES)
  _rds_install_program(${service} services)
  string(REGEX REPLACE "^rds-" "" name ${service})
  string(REPLACE "-" "_" name ${name})
  install(FILES services/${name}/${name}.yaml DESTINATION share/rds-slam/settings COMPONENT services)
endforeach()
install(FILES common/labels/labels.yaml DESTINATION share/rds-slam/settings COMPONENT services)
install(FILES services/viewer/foxglove/layout.json services/viewer/foxglove/rds.rviz services/viewer/metrics/dashboard.json
  DESTINATION share/rds-slam/viewer COMPONENT services)
install(DIRECTORY ${CMAKE_BINARY_DIR}/lib/openvino DESTINATION ${RDS_PRIVATE}/lib COMPONENT services)
if(TARGET rds_zenoh)
  install(FILES ${CMAKE_BINARY_DIR}/lib/librds_zenoh.so DESTINATION ${RDS_PRIVATE}/lib COMPONENT services)
  install(CODE "
    if(CMAKE_INSTALL_DO_STRIP)  # of files that are no targets CMake strips none
      execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-unneeded \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${RDS_PRIVATE}/lib/librds_zenoh.so\"
        COMMAND_ERROR_IS_FATAL ANY)
    endif()" COMPONENT services)
endif()
install(FILES README.md DESTINATION share/doc/rds-slam COMPONENT services)

# The same programs as a package of ROS 2, which ament finds by a file of its name.
foreach(service IN LISTS RDS_SERVICES)
  _rds_install_link(../rds-slam/bin/${service} ${service} lib/rds_slam services)
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/install/ament/rds_slam "")
configure_file(tools/ros/package.xml install/ament/package.xml @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/install/ament/rds_slam DESTINATION share/ament_index/resource_index/packages COMPONENT services)
install(FILES ${CMAKE_BINARY_DIR}/install/ament/package.xml DESTINATION share/rds_slam COMPONENT services)
install(FILES tools/ros/launch/rds_slam.launch.xml DESTINATION share/rds_slam/launch COMPONENT services)
install(FILES tools/systemd/README.md DESTINATION share/doc/rds-slam RENAME systemd.md COMPONENT services)
install(FILES services/viewer/page/vendor/three/LICENSE.txt DESTINATION share/doc/rds-slam RENAME three.js.txt COMPONENT services)
file(GLOB openvino_licenses ${PROJECT_SOURCE_DIR}/.venv/lib/python3*/site-packages/openvino-*.dist-info/licenses)
if(TARGET rds_openvino AND openvino_licenses)
  install(DIRECTORY ${openvino_licenses}/ DESTINATION share/doc/rds-slam/openvino COMPONENT services)
endif()

# The units with the programs' place; which prefix, is known when they are installed.
install(CODE "
  foreach(unit rds-slam.target rds-slam@.service)
    file(READ \"${PROJECT_SOURCE_DIR}/tools/systemd/\${unit}\" text)
    string(REPLACE /usr/local \"\${CMAKE_INSTALL_PREFIX}\" text \"\${text}\")
    file(MAKE_DIRECTORY \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system\")
    file(WRITE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/\${unit}\" \"\${text}\")
  endforeach()" COMPONENT services)

# --- tools
_rds_install_program(rds tools)
install(PROGRAMS tools/networks/fetch_nanodet_g.sh DESTINATION share/rds-slam/networks COMPONENT tools)
install(FILES tools/networks/convert_tfjs.py tools/networks/tfjs_model.py tools/networks/tfjs_to_onnx.py tools/networks/requirements.txt
  DESTINATION share/rds-slam/networks COMPONENT tools)
_rds_install_link(../../share share ${RDS_PRIVATE} tools)

get_property(documents GLOBAL PROPERTY RDS_DOCUMENTS)
if(documents)
  add_custom_target(rds_documents ALL DEPENDS ${documents})
endif()

# --- dev: what a reader of the map links, with all that this needs.
set(RDS_PUBLIC_HEADERS
  common/bus/participant.hpp common/messages/conversions.hpp common/topics/endpoints.hpp
  services/mapper/core/octree/octree_replica.hpp services/mapper/core/octree/tree_bytes.hpp
  services/mapper/core/octree/voxel_walk.hpp services/mapper/reader/map_follower.hpp)

# find_package() that brings each library of others, which static libraries leave to their users.
set(finds_fastrtps fastrtps)
set(finds_fastcdr fastcdr)
set(finds_CycloneDDS CycloneDDS)
set(finds_Eigen3 Eigen3)
set(finds_octomap octomap)
set(finds_octomath octomap)
set(finds_fmt fmt)
set(finds_spdlog spdlog)
set(finds_tl tl-expected)
set(finds_CLI11 CLI11)
set(finds_nlohmann_json nlohmann_json)
set(finds_SQLite SQLite3)
set(finds_Threads Threads)
set(finds_yaml-cpp yaml-cpp)
set(finds_OpenSSL OpenSSL)
set(finds_opencv_core OpenCV)
set(finds_opencv_imgproc OpenCV)

function(_rds_install_dev)
  _rds_closure(rds_map_follower reached)
  set(own)
  set(packages)
  set(pkg_config)
  foreach(target IN LISTS reached)
    string(REGEX REPLACE "::.*" "" family ${target})
    if(target MATCHES "^rds_")
      list(APPEND own ${target})
      string(REPLACE "rds_" "" name ${target})
      set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    elseif(target MATCHES "^PkgConfig::(.*)")
      list(APPEND pkg_config ${CMAKE_MATCH_1})
    elseif(finds_${family})
      list(APPEND packages ${finds_${family}})
    elseif(NOT target STREQUAL dl AND NOT IS_ABSOLUTE ${target})
      message(FATAL_ERROR "${target}: librds-slam-dev needs it; say in RdsInstall.cmake which find_package() has it")
    endif()
  endforeach()
  list(REMOVE_DUPLICATES packages)
  set(RDS_FINDS)
  foreach(package IN LISTS packages)
    string(APPEND RDS_FINDS "find_dependency(${package})\n")
  endforeach()
  if(pkg_config)
    string(APPEND RDS_FINDS "find_dependency(PkgConfig)\n")
  endif()
  foreach(module IN LISTS pkg_config)
    string(TOLOWER lib${module} library)
    string(APPEND RDS_FINDS "pkg_check_modules(${module} REQUIRED QUIET IMPORTED_TARGET ${library})\n")
  endforeach()

  install(TARGETS ${own} EXPORT rds ARCHIVE DESTINATION ${RDS_DEV_LIB} COMPONENT dev)
  install(EXPORT rds NAMESPACE rds:: FILE rds-targets.cmake DESTINATION ${RDS_DEV_LIB}/cmake/rds COMPONENT dev)
  include(CMakePackageConfigHelpers)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/packages/rds-config.cmake.in ${CMAKE_BINARY_DIR}/install/rds-config.cmake
    INSTALL_DESTINATION ${RDS_DEV_LIB}/cmake/rds NO_SET_AND_CHECK_MACRO)
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/install/rds-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/install/rds-config.cmake ${CMAKE_BINARY_DIR}/install/rds-config-version.cmake
    DESTINATION ${RDS_DEV_LIB}/cmake/rds COMPONENT dev)
endfunction()
_rds_install_dev()

execute_process(COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/cmake/header_closure.py ${PROJECT_SOURCE_DIR} ${RDS_PUBLIC_HEADERS}
  OUTPUT_VARIABLE headers OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" headers "${headers}")
foreach(header IN LISTS headers)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION include/rds-slam/${folder} COMPONENT dev)
endforeach()
install(DIRECTORY ${CMAKE_BINARY_DIR}/idl/generated/ DESTINATION include/rds-slam COMPONENT dev FILES_MATCHING PATTERN "*.h")
install(DIRECTORY idl/rds_msgs/msg idl/rds_msgs/srv DESTINATION share/rds-slam/rds_msgs COMPONENT dev)
install(DIRECTORY docs/examples/cpp docs/examples/python DESTINATION share/doc/librds-slam-dev/examples COMPONENT dev)
