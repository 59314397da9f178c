// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/geometry/box.hpp"
#include "services/detector/core/inference_backend.hpp"
#include "services/detector/core/network_description.hpp"

namespace rds::detector {

/// A box the network proposes, before non-maximum suppression.
struct Candidate {
  int label = 0;  // index into NetworkDescription::labels
  float score = 0;
  geometry::Box2 box;  // [px] of the network's input
};

/// Turns a network's raw outputs into candidates.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;

  /// @return candidates with score ≥ min_score, in the order of the outputs; values that are not finite are
  /// skipped.
  /// @throws DetectorError if the outputs do not have the shape the description promises.
  [[nodiscard]] virtual std::vector<Candidate> decode(std::span<const NamedTensor> outputs,
                                                      float min_score) const = 0;
};

std::unique_ptr<Decoder> make_decoder(const NetworkDescription& network);

/// SSD: centre-size code relative to prior boxes, scores already activated, class 0 is the background.
/// Source: Liu et al. 2016, §2.2; order of the priors as in Caffe's PriorBox layer.
std::unique_ptr<Decoder> make_ssd_decoder(const NetworkDescription& network);

/// YOLOX: per cell x, y (in cells), log width and height, objectness, class scores. Source: Ge et al. 2021,
/// §2.2.
std::unique_ptr<Decoder> make_yolox_decoder(const NetworkDescription& network);

/// NanoDet: per cell class scores, and for each side a distribution over `bins` distances [strides].
/// Source: Li et al. 2020 (Generalized Focal Loss), §3.2.
std::unique_ptr<Decoder> make_nanodet_decoder(const NetworkDescription& network);

/// Centres [px of the input] and sizes [px] of an SSD's prior boxes, in the order of its outputs.
struct Prior {
  double center_x = 0;
  double center_y = 0;
  double width = 0;
  double height = 0;
};
std::vector<Prior> ssd_priors(const InputDescription& input, std::span<const SsdMap> maps);

/// Rows × columns view of a tensor whose last dimensions multiply to `columns`.
/// @throws DetectorError if its values cannot be divided into such rows.
cv::Mat as_rows(const NamedTensor& tensor, int columns);

}  // namespace rds::detector
