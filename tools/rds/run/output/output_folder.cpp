// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/output/output_folder.hpp"

#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "common/map_file/replace_folder.hpp"

namespace rds::run {
namespace fs = std::filesystem;
namespace {

void check_may_be_replaced(const fs::path& wanted, bool force) {
  if (!fs::exists(wanted)) return;
  if (!fs::is_directory(wanted))
    throw std::runtime_error(fmt::format("{}: is not a folder", wanted.string()));
  if (fs::is_empty(wanted)) return;
  const bool is_run = fs::exists(wanted / "summary.json");
  if (!is_run)
    throw std::runtime_error(fmt::format(
        "{}: holds files that are not a run's, expected an empty or new folder", wanted.string()));
  if (!force)
    throw std::runtime_error(
        fmt::format("{}: already holds a run, use --force to overwrite it", wanted.string()));
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& wanted, bool force)
    : wanted_(fs::absolute(wanted).lexically_normal()) {
  if (!wanted_.has_filename()) wanted_ = wanted_.parent_path();
  check_may_be_replaced(wanted_, force);
  partial_ = wanted_;
  partial_ += fmt::format(".partial-{}", getpid());
  std::error_code error;
  fs::create_directories(partial_, error);
  if (error)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", wanted_.string(), error.message()));
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!published_) fs::remove_all(partial_, ignored);
}

void OutputFolder::publish() {
  const auto replaced = map_file::replace_folder(AT_FDCWD, partial_, AT_FDCWD, wanted_);
  if (!replaced)
    throw std::runtime_error(fmt::format("{}: cannot be written: {}", wanted_.string(), replaced.error()));
  published_ = true;
  std::error_code ignored;
  if (*replaced) fs::remove_all(partial_, ignored);  // the earlier run
}

}  // namespace rds::run
