// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/doctor/checks/dataset_check.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "tools/rds/doctor/checks/camera_check.hpp"
#include "tools/rds/doctor/checks/color_checks.hpp"
#include "tools/rds/doctor/checks/depth_checks.hpp"
#include "tools/rds/doctor/checks/list_checks.hpp"
#include "tools/rds/doctor/checks/registration_check.hpp"
#include "tools/rds/doctor/checks/sensor_check.hpp"

namespace rds::doctor {
namespace {
constexpr double kManyUnreadable = 0.1;  // of the frames looked at
}  // namespace

Finding check_unreadable(const RecordingLooks& looks) {
  const std::size_t all = looks.frames.size() + looks.unreadable.size();
  if (looks.unreadable.empty())
    return {Verdict::kGood, "pictures", fmt::format("all of {} frames looked at can be read", all)};
  const bool many = static_cast<double>(looks.unreadable.size()) > kManyUnreadable * static_cast<double>(all);
  return {many ? Verdict::kFault : Verdict::kHint, "pictures",
          fmt::format("{} of {} frames cannot be read and will be skipped; {}", looks.unreadable.size(), all,
                      looks.unreadable.front())};
}

std::vector<Finding> check_dataset(const image::Recording& dataset, std::size_t every) {
  const auto& camera = dataset.camera();
  const auto lists = lists_of(dataset);
  std::vector<Finding> findings{check_camera(camera),
                                check_counts(lists),
                                check_files(lists),
                                check_pairing(lists, camera.fx),
                                check_rate(lists, dataset.fps()),
                                check_gaps(lists),
                                check_truth(lists)};
  std::ranges::copy(check_sensors(dataset), std::back_inserter(findings));
  const auto looks = look_at_pictures(dataset, every);
  findings.push_back(check_unreadable(looks));
  if (looks.frames.empty()) return findings;
  const auto registration =
      fit_registration(looks.edges, {camera.cx, camera.cy}, {camera.width, camera.height});
  for (const auto& finding :
       {check_frozen(looks.frames), check_blur(looks.frames), check_exposure(looks.frames),
        check_exposure_jumps(looks.frames), check_depth_scale(looks.frames, dataset.depth_scale()),
        check_depth_share(looks.frames), check_depth_values(looks.frames), check_depth_frozen(looks.frames),
        check_registration(registration, camera)})
    findings.push_back(finding);
  return findings;
}

}  // namespace rds::doctor
