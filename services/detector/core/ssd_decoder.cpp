// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/detector/core/decoder.hpp"
#include "services/detector/core/detection.hpp"

namespace rds::detector {
namespace {

void append_cell_priors(const SsdMap& map, double center_x, double center_y, std::vector<Prior>& priors) {
  priors.push_back({center_x, center_y, map.min_size, map.min_size});
  if (map.max_size > 0) {
    const double side = std::sqrt(map.min_size * map.max_size);
    priors.push_back({center_x, center_y, side, side});
  }
  for (const double ratio : map.ratios) {
    const double root = std::sqrt(ratio);
    priors.push_back({center_x, center_y, map.min_size * root, map.min_size / root});
    priors.push_back({center_x, center_y, map.min_size / root, map.min_size * root});
  }
}

class SsdDecoder final : public Decoder {
 public:
  explicit SsdDecoder(const NetworkDescription& network)
      : decoder_(network.decoder),
        labels_(static_cast<int>(network.labels.size())),
        priors_(ssd_priors(network.input, network.decoder.maps)) {}

  [[nodiscard]] std::vector<Candidate> decode(std::span<const NamedTensor> outputs,
                                              float min_score) const override {
    const cv::Mat codes = rows_of(outputs, decoder_.boxes_output, 4);
    const cv::Mat scores = rows_of(outputs, decoder_.scores_output, labels_ + 1);
    std::vector<Candidate> candidates;
    for (int i = 0; i < scores.rows; ++i) {
      const auto* score = scores.ptr<float>(i);
      for (int c = 1; c <= labels_; ++c) {
        if (!(score[c] >= min_score)) continue;
        const geometry::Box2 box = decode_box(codes.ptr<float>(i), priors_[static_cast<std::size_t>(i)]);
        if (std::isfinite(box.area())) candidates.push_back({c - 1, score[c], box});
      }
    }
    return candidates;
  }

 private:
  [[nodiscard]] cv::Mat rows_of(std::span<const NamedTensor> outputs, const std::string& name,
                                int columns) const {
    const auto output = std::ranges::find(outputs, name, &NamedTensor::name);
    if (output == outputs.end()) throw DetectorError(fmt::format("the network has no output '{}'", name));
    cv::Mat rows = as_rows(*output, columns);
    if (rows.rows != static_cast<int>(priors_.size()))
      throw DetectorError(
          fmt::format("output '{}' of the network: expected {} rows (one per prior box), got {}", name,
                      priors_.size(), rows.rows));
    return rows;
  }

  [[nodiscard]] geometry::Box2 decode_box(const float* code, const Prior& prior) const {
    const auto& variance = decoder_.variances;
    const double x = prior.center_x + code[0] * variance[0] * prior.width;
    const double y = prior.center_y + code[1] * variance[1] * prior.height;
    const double half_width = prior.width * std::exp(code[2] * variance[2]) / 2;
    const double half_height = prior.height * std::exp(code[3] * variance[3]) / 2;
    return {x - half_width, y - half_height, x + half_width, y + half_height};
  }

  DecoderDescription decoder_;
  int labels_;
  std::vector<Prior> priors_;
};

}  // namespace

std::vector<Prior> ssd_priors(const InputDescription& input, std::span<const SsdMap> maps) {
  std::vector<Prior> priors;
  for (const SsdMap& map : maps)
    for (int row = 0; row < map.cells; ++row)
      for (int column = 0; column < map.cells; ++column)
        append_cell_priors(map, (column + 0.5) * input.width / map.cells,
                           (row + 0.5) * input.height / map.cells, priors);
  return priors;
}

std::unique_ptr<Decoder> make_ssd_decoder(const NetworkDescription& network) {
  return std::make_unique<SsdDecoder>(network);
}

}  // namespace rds::detector
