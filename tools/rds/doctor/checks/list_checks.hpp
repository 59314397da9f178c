// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/rds/doctor/checks/finding.hpp"
#include "tools/rds/doctor/checks/recording_lists.hpp"

namespace rds::doctor {

/// Pictures, colour pictures without depth in reach, stamps given twice.
Finding check_counts(const RecordingLists& lists);
/// Pictures that are listed but not there.
Finding check_files(const RecordingLists& lists);
/// How far apart in time colour and depth were taken, and what that is in pixels when the camera turns.
Finding check_pairing(const RecordingLists& lists, double focal_px);
/// The frame rate: is it the camera's, is it even?
Finding check_rate(const RecordingLists& lists, double fps);
/// Stretches without frames.
Finding check_gaps(const RecordingLists& lists);
/// Ground truth for the frames.
Finding check_truth(const RecordingLists& lists);

}  // namespace rds::doctor
