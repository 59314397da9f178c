# SPDX-License-Identifier: Apache-2.0
# OpenVINO, the detector's faster inference library. Without it everything is built and works, with OpenCV alone.
#
# RDS_OPENVINO  AUTO: used where it is found, in .venv (tools/setup.sh puts it there) or where CMAKE_PREFIX_PATH or
#               OpenVINO_DIR says; ON: required; OFF: left out.
#
# Defines the target rds_openvino where it is used. The libraries that a program needs are linked into <build>/lib/openvino,
# beside each other, where OpenVINO looks for its parts; so bin/ and lib/ can be taken elsewhere together.
set(RDS_OPENVINO AUTO CACHE STRING "OpenVINO: AUTO, ON or OFF")
set_property(CACHE RDS_OPENVINO PROPERTY STRINGS AUTO ON OFF)

# gather_libraries(FOLDER library...): hard links, or copies from another file system.
function(_rds_gather_libraries folder)
  foreach(library IN LISTS ARGN)
    cmake_path(GET library FILENAME name)
    file(REAL_PATH ${library} original)
    file(CREATE_LINK ${original} ${folder}/${name} COPY_ON_ERROR)
  endforeach()
endfunction()

set(openvino_folder ${CMAKE_BINARY_DIR}/lib/openvino)
file(REMOVE_RECURSE ${openvino_folder})
file(MAKE_DIRECTORY ${openvino_folder})
if(RDS_OPENVINO)
  file(GLOB wheel ${PROJECT_SOURCE_DIR}/.venv/lib/python3*/site-packages/openvino/cmake)
  find_package(OpenVINO CONFIG QUIET COMPONENTS Runtime HINTS ${wheel})
  remove_definitions(-D_GLIBCXX_USE_CXX11_ABI=1)  # what it adds for everybody; its target says it to those who use it
  if(NOT OpenVINO_FOUND AND NOT RDS_OPENVINO STREQUAL AUTO)
    message(FATAL_ERROR "RDS_OPENVINO=${RDS_OPENVINO}: OpenVINO is not found; tools/setup.sh puts it into .venv, OpenVINO_DIR names another place")
  endif()
endif()
if(RDS_OPENVINO AND OpenVINO_FOUND)
  get_target_property(library openvino::runtime IMPORTED_LOCATION_RELEASE)
  cmake_path(GET library PARENT_PATH folder)
  cmake_path(GET library FILENAME name)
  file(GLOB parts ${folder}/libopenvino_onnx_frontend.so.* ${folder}/libopenvino_*_cpu_plugin.so ${folder}/libtbb.so.* ${folder}/libtbbmalloc.so.*)
  _rds_gather_libraries(${openvino_folder} ${library} ${parts})
  add_library(rds_openvino INTERFACE)
  target_include_directories(rds_openvino SYSTEM INTERFACE $<TARGET_PROPERTY:openvino::runtime,INTERFACE_INCLUDE_DIRECTORIES>)
  # Debian's OpenCV needs a libtbb as well, and a process holds only one of that name. RPATH, unlike RUNPATH, holds for OpenCV,
  # too: both get OpenVINO's, which is the newer one.
  target_link_libraries(rds_openvino INTERFACE
    -L${openvino_folder} -l:${name} -Wl,--disable-new-dtags "-Wl,-rpath,'$$ORIGIN/../lib/openvino'")
  message(STATUS "OpenVINO ${OpenVINO_VERSION}: ${folder}")
else()
  message(STATUS "OpenVINO: not used, the detector has OpenCV alone")
endif()
