// SPDX-License-Identifier: Apache-2.0
#include "tests/support/shared_data.hpp"

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "tests/support/temporary_folder.hpp"

namespace rds::test {
namespace {

/// Where the fixtures put what they make; empty if the test was not declared so.
std::filesystem::path made_recordings() {
  const char* folder = std::getenv("RDS_RECORDINGS");
  return folder == nullptr ? "" : folder;
}

std::size_t lines_in(const std::filesystem::path& list) {
  std::istringstream lines(read_text(list));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.empty() || line.front() == '#' ? 0U : 1U;
  return count;
}

TestRecording as_it_is(const std::filesystem::path& folder, bool rendered) {
  return {folder, lines_in(folder / "rgb.txt"), rendered};
}

}  // namespace

std::filesystem::path shared() {
  const char* folder = std::getenv("RDS_SHARED");
  return folder == nullptr ? "" : folder;
}

std::string why_not_shared(const std::string& name) {
  if (shared().empty()) return "RDS_SHARED is not set, so there is no recording " + name;
  if (!std::filesystem::exists(shared() / name)) return (shared() / name).string() + " is missing";
  return "";
}

std::filesystem::path dynamic_sequence(const std::string& name) {
  const auto folder = made_recordings() / "dynamic" / name;
  return shared().empty() || !exists(folder / "made") ? "" : folder;
}

std::filesystem::path rendered_recording(const std::string& name) {
  const auto folder = made_recordings() / "rendered" / name;
  if (!exists(folder / "made"))
    throw std::runtime_error("recording " + name + " was not rendered: RDS_RECORDINGS, which ctest sets");
  return folder;
}

TestRecording recording_of_a_room() {
  const std::string kitchen = "data/7scenes_kitchen";
  return why_not_shared(kitchen).empty() ? as_it_is(shared() / kitchen, false)
                                         : as_it_is(rendered_recording("room_empty"), true);
}

TestRecording recording_with_people() {
  const auto walkers = dynamic_sequence("kitchen_walkers");
  return walkers.empty() ? as_it_is(rendered_recording("room"), true) : as_it_is(walkers, false);
}

}  // namespace rds::test
