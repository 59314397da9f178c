// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "common/geometry/camera_model.hpp"
#include "common/geometry/oriented_box.hpp"
#include "services/transformer/core/transformer_config.hpp"

namespace rds::transformer {

/// The 3-D box, in the map, of what an image box shows.
///
/// The box's top-left and bottom-right corners at the depth of the box become P_w1 and P_w2. The result is
/// aligned with the camera, has both points in its middle plane (z = 0), and the thickness of its label along
/// the optical axis.
/// @param box      [px] in the picture with distortion; the part outside the picture is cut off.
/// @param depth_m  along the optical axis.
/// @return nullopt if anything is not finite, the depth is not in [min_depth_m, max_depth_m], less than one
/// pixel of the box's width or height is in the picture, or the camera model is invalid.
/// Source: paper §IV-B, P_w = T_kcw⁻¹ · P_kc in eq. (1). Deviation: the paper's boxes have no thickness.
std::optional<geometry::OrientedBox> box_in_map(const geometry::Box2& box, double depth_m,
                                                std::string_view label, const geometry::Pose& map_from_camera,
                                                const geometry::CameraModel& camera,
                                                const TransformerConfig& config = {});

}  // namespace rds::transformer
