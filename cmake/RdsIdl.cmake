# SPDX-License-Identifier: Apache-2.0
# C++ types from IDL at build time.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
find_package(fastcdr REQUIRED)
find_program(FASTDDSGEN fastddsgen REQUIRED)

# rds_idl_library(NAME ROOTS dirs...)
# Generates <build>/<package>/msg/<Name>.h and .cxx for every <root>/<package>/<Name>.idl (srv instead of msg for
# <Name>_Request and <Name>_Response) and builds them as one static library that needs Fast CDR only. Sets NAME_IDL_FILES to the files, for those who generate more from them.
function(rds_idl_library name)
  cmake_parse_arguments(A "" "" "ROOTS" ${ARGN})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/generated)
  set(root_arguments)
  set(files)
  foreach(root IN LISTS A_ROOTS)
    list(APPEND root_arguments --root ${root})
    file(GLOB root_files CONFIGURE_DEPENDS ${root}/*/*.idl)
    list(APPEND files ${root_files})
  endforeach()

  set(packages)
  foreach(file IN LISTS files)
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(GET folder FILENAME package)
    cmake_path(GET file STEM type)
    list(APPEND packages ${package})
    list(APPEND idl_${package} ${file})
    set(kind msg)
    if(type MATCHES "_(Request|Response)$")
      set(kind srv)
    endif()
    list(APPEND generated_${package} ${out}/${package}/${kind}/${type}.h ${out}/${package}/${kind}/${type}.cxx)
  endforeach()
  list(REMOVE_DUPLICATES packages)

  set(sources)
  foreach(package IN LISTS packages)
    add_custom_command(
      OUTPUT ${generated_${package}}
      COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/idl_fastddsgen.py --fastddsgen ${FASTDDSGEN} ${root_arguments}
              --scratch ${CMAKE_CURRENT_BINARY_DIR}/scratch/${package} --out ${out} ${idl_${package}}
      DEPENDS ${files} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/idl_fastddsgen.py ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/idl_model.py
      COMMENT "fastddsgen ${package}" VERBATIM)
    list(APPEND sources ${generated_${package}})
  endforeach()

  # Generated code is not ours to warn about: it gets neither rds_options nor its users' warnings (SYSTEM).
  add_library(${name} STATIC ${sources})
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE -w)
  target_include_directories(${name} SYSTEM PUBLIC $<BUILD_INTERFACE:${out}> $<INSTALL_INTERFACE:include/rds-slam>)
  target_link_libraries(${name} PUBLIC fastcdr)
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 20 CXX_CLANG_TIDY "" EXPORT_COMPILE_COMMANDS OFF)
  set(${name}_IDL_FILES ${files} PARENT_SCOPE)
endfunction()

# rds_message_support(OUT_VAR OUT dir ROOTS dirs... FILES idl files...)
# Generates the per-package sources of cmake/idl_support.py below dir; OUT_VAR lists those to compile.
function(rds_message_support out_var)
  cmake_parse_arguments(A "" "OUT" "ROOTS;FILES" ${ARGN})
  set(root_arguments)
  foreach(root IN LISTS A_ROOTS)
    list(APPEND root_arguments --root ${root})
  endforeach()
  set(sources ${A_OUT}/message_registry.cpp ${A_OUT}/message_definitions.cpp)
  set(headers)
  foreach(file IN LISTS A_FILES)
    cmake_path(GET file PARENT_PATH folder)
    cmake_path(GET folder FILENAME package)
    list(APPEND sources ${A_OUT}/${package}/message_support.cpp)
    list(APPEND headers ${A_OUT}/${package}/message_fields.hpp)
  endforeach()
  list(REMOVE_DUPLICATES sources)
  list(REMOVE_DUPLICATES headers)
  add_custom_command(
    OUTPUT ${sources} ${headers}
    COMMAND Python3::Interpreter -B ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/idl_support.py ${root_arguments} --out ${A_OUT}
    DEPENDS ${A_FILES} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/idl_support.py ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/idl_model.py
    COMMENT "message support" VERBATIM)
  set(${out_var} ${sources} ${headers} PARENT_SCOPE)
endfunction()
