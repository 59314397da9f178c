// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/network_description.hpp"

#include <algorithm>
#include <cctype>

namespace rds::detector {
namespace {

constexpr int kLargestInputPx = 4096;

/// N numbers within [lowest, highest]; an absent key keeps the default.
template <std::size_t N>
void read_array(config::ConfigReader& r, const std::string& key, std::array<double, N>& target, double lowest,
                double highest) {
  std::vector<double> values(target.begin(), target.end());
  r.value(key, values);
  const auto in_range = [&](double v) { return v >= lowest && v <= highest; };
  if (values.size() != N || !std::ranges::all_of(values, in_range))
    r.violation(key, fmt::format("[{}]", fmt::join(values, ", ")),
                fmt::format("expected {} numbers {} … {}", N, lowest, highest));
  else
    std::ranges::copy(values, target.begin());
}

void read_input(config::ConfigReader& r, InputDescription& input) {
  r.value("width", input.width, 1, kLargestInputPx, "px");
  r.value("height", input.height, 1, kLargestInputPx, "px");
  if (input.width == 0 || input.height == 0)
    r.violation("width, height", "absent", "expected the input's size");
  std::string order = "bgr";
  r.choice("order", order, {"bgr", "rgb"});
  input.order = order == "bgr" ? InputOrder::kBgr : InputOrder::kRgb;
  std::string resize = "stretch";
  r.choice("resize", resize, {"stretch", "letterbox", "centred_letterbox"});
  input.resize = resize == "stretch"     ? Resize::kStretch
                 : resize == "letterbox" ? Resize::kLetterbox
                                         : Resize::kCentredLetterbox;
  r.value("pad_value", input.pad_value, 0.0, 255.0);
  read_array(r, "mean", input.mean, -1000.0, 1000.0);
  read_array(r, "deviation", input.deviation, 1e-6, 1e6);
}

void read_ssd(config::ConfigReader& r, DecoderDescription& decoder) {
  std::vector<int> cells;
  std::vector<double> min_sizes;
  std::vector<double> max_sizes;
  std::vector<std::vector<double>> ratios;
  r.value("boxes_output", decoder.boxes_output);
  r.value("scores_output", decoder.scores_output);
  read_array(r, "variances", decoder.variances, 1e-6, 10.0);
  r.value("cells", cells);
  r.value("min_sizes", min_sizes);
  r.value("max_sizes", max_sizes);
  r.value("ratios", ratios);
  const std::size_t n = cells.size();
  if (n == 0 || min_sizes.size() != n || max_sizes.size() != n || ratios.size() != n)
    return r.violation("cells", fmt::format("{} maps", n),
                       "expected as many min_sizes, max_sizes and ratios, at least 1");
  for (std::size_t i = 0; i < n; ++i) {
    const bool positive = cells[i] > 0 && cells[i] <= kLargestInputPx && min_sizes[i] > 0 &&
                          max_sizes[i] >= 0 &&
                          std::ranges::all_of(ratios[i], [](double ratio) { return ratio > 0; });
    if (!positive)
      r.violation("cells", fmt::format("map {}", i), "expected positive cells, sizes and ratios");
    decoder.maps.push_back({cells[i], min_sizes[i], max_sizes[i], ratios[i]});
  }
}

void read_decoder(config::ConfigReader& r, DecoderDescription& decoder) {
  std::string kind = "absent";
  r.choice("kind", kind, {"ssd", "yolox", "nanodet"});
  if (kind == "absent") return r.violation("kind", kind, "expected one of: ssd, yolox, nanodet");
  decoder.kind = kind == "ssd"     ? DecoderKind::kSsd
                 : kind == "yolox" ? DecoderKind::kYolox
                                   : DecoderKind::kNanodet;
  if (decoder.kind == DecoderKind::kSsd) return read_ssd(r, decoder);
  r.value("strides", decoder.strides);
  const auto valid = [](int stride) { return stride >= 1 && stride <= kLargestInputPx; };
  if (decoder.strides.empty() || !std::ranges::all_of(decoder.strides, valid))
    r.violation("strides", fmt::format("[{}]", fmt::join(decoder.strides, ", ")),
                "expected at least one positive stride");
  if (decoder.kind == DecoderKind::kNanodet) {
    r.value("bins", decoder.bins, 2, 64);
    if (decoder.bins == 0) r.violation("bins", "absent", "expected 2 … 64");
  }
}

void check_file(config::ConfigReader& r, const NetworkDescription& network) {
  if (network.name.empty()) r.violation("name", "absent", "expected the network's name");
  if (network.file.empty() || network.file.find('/') != std::string::npos)
    r.violation("file", network.file, "expected a file name without a folder");
  const auto is_hex = [](unsigned char c) { return std::isdigit(c) || (c >= 'a' && c <= 'f'); };
  if (network.sha256.size() != 64 || !std::ranges::all_of(network.sha256, is_hex))
    r.violation("sha256", network.sha256, "expected 64 hexadecimal digits in lower case");
  if (network.labels.empty()) r.violation("labels", "absent", "expected at least one label");
}

}  // namespace

NetworkDescription parse_network(const YAML::Node& node, const std::string& source) {
  config::ConfigReader r(node, source);
  NetworkDescription network;
  r.value("name", network.name);
  r.value("file", network.file);
  r.value("sha256", network.sha256);
  r.value("labels", network.labels);
  r.value("score_threshold", network.score_threshold, 0.0, 1.0);
  r.value("nms_iou", network.nms_iou, 0.0, 1.0);
  r.value("licence", network.licence);
  r.value("source", network.source);
  r.value("fetch", network.fetch);
  read_input(r.section("input"), network.input);
  read_decoder(r.section("decoder"), network.decoder);
  check_file(r, network);
  r.finish();
  return network;
}

}  // namespace rds::detector
