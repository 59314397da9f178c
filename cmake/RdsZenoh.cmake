# SPDX-License-Identifier: Apache-2.0
# librds_zenoh.so, the crate in common/bus/zenoh/crate: programs load it when --bus zenoh asks for it (../lib from where they are), so
# nothing else of the build waits for it.

option(RDS_ZENOH "Build the crate behind --bus zenoh, where there is a cargo" ON)
if(RDS_ZENOH AND RDS_SANITIZE STREQUAL thread)
  message(STATUS "Zenoh: left out, the thread sanitizer does not see what Rust's atomics order")
elseif(RDS_ZENOH)
  find_program(RDS_CARGO cargo HINTS $ENV{HOME}/.cargo/bin)
  if(RDS_CARGO)
    set(library ${CMAKE_BINARY_DIR}/lib/librds_zenoh.so)
    set(zenoh ${PROJECT_SOURCE_DIR}/common/bus/zenoh)
    file(GLOB sources CONFIGURE_DEPENDS ${zenoh}/crate/src/*.rs ${zenoh}/patches/*.rs ${zenoh}/patches/*.sed)
    add_custom_command(OUTPUT ${library}
      COMMAND ${zenoh}/build_crate.sh ${RDS_CARGO} ${library}
      DEPENDS ${sources} ${zenoh}/crate/Cargo.toml ${zenoh}/crate/Cargo.lock ${zenoh}/build_crate.sh ${zenoh}/patches/patched_crate.sh
      COMMENT "Zenoh: building librds_zenoh.so (minutes the first time)" VERBATIM)
    add_custom_target(rds_zenoh ALL DEPENDS ${library})
    cmake_path(GET RDS_CARGO PARENT_PATH beside_cargo)
    find_program(RDS_CLIPPY cargo-clippy PATHS ${beside_cargo} NO_DEFAULT_PATH)  # another compiler's would not fit
  else()
    message(STATUS "Zenoh: left out, there is no cargo (tools/setup.sh installs one)")
  endif()
endif()

# rds_runs_on_zenoh(TARGET): a test of all vendors (tests/support/bus/vendors.hpp): on Zenoh as well, where it is built.
function(rds_runs_on_zenoh target)
  target_link_libraries(${target} PRIVATE rds_bus)
  target_compile_definitions(${target} PRIVATE RDS_HAS_ZENOH=$<TARGET_EXISTS:rds_zenoh>)
  if(TARGET rds_zenoh)
    add_dependencies(${target} rds_zenoh)
  endif()
endfunction()
