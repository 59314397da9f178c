// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/recordings.hpp"

#include <stdexcept>

#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::test {
namespace {

constexpr double kTurnS = 8;
constexpr double kLengthS = 30;

RecordingPair whole(const std::string& name) {
  if (name == "walkers") {
    const TestRecording people = recording_with_people();
    return {people.folder,
            people.rendered ? rendered_recording("room_empty") : shared() / "data/7scenes_kitchen"};
  }
  if (name != "rpy") throw std::runtime_error(name + ": no such recording");
  const auto folder =
      why_not_shared("data/tum_fr1_rpy").empty() ? shared() / "data/tum_fr1_rpy" : rendered_recording("room_empty");
  return {folder, folder};
}

}  // namespace

RecordingPair to_and_fro(const std::string& name, const std::filesystem::path& place) {
  const auto [dataset, background] = whole(name);
  make_to_and_fro(dataset, place / name, kTurnS, kLengthS);
  make_to_and_fro(background, place / (name + "_background"), kTurnS, kLengthS);
  return {place / name, place / (name + "_background")};
}

}  // namespace rds::test
