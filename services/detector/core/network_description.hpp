// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"

namespace rds::detector {

enum class InputOrder { kRgb, kBgr };
enum class Resize {
  kStretch,          // both axes fill the input, aspect lost
  kLetterbox,        // aspect kept, picture at the top left
  kCentredLetterbox  // aspect kept, picture in the middle
};
enum class DecoderKind { kSsd, kYolox, kNanodet };

/// How a picture becomes the network's input: resized to width × height, value = (pixel − mean) / deviation.
struct InputDescription {
  int width = 0;  // [px]
  int height = 0;
  InputOrder order = InputOrder::kBgr;
  Resize resize = Resize::kStretch;
  double pad_value = 0;  // pixel value of what a letterbox leaves free, before the mean is taken off
  std::array<double, 3> mean{0, 0, 0};  // in the input's channel order
  std::array<double, 3> deviation{1, 1, 1};
};

/// Anchor boxes of one SSD feature map, in Caffe's PriorBox order.
struct SsdMap {
  int cells = 0;               // per axis
  double min_size = 0;         // [px] of the input
  double max_size = 0;         // 0: no second square box
  std::vector<double> ratios;  // each also flipped
};

struct DecoderDescription {
  DecoderKind kind = DecoderKind::kSsd;
  std::vector<int> strides;   // yolox, nanodet [px]
  std::vector<SsdMap> maps;   // ssd
  std::string boxes_output;   // ssd: name of the 1×N×4 output
  std::string scores_output;  // ssd: name of the 1×N×classes output, class 0 is the background
  std::array<double, 4> variances{0.1, 0.1, 0.2, 0.2};
  int bins = 0;  // nanodet: bins of each side's distance distribution
};

/// Everything that has to be known about one trained network. One YAML file each, see
/// services/detector/models.
struct NetworkDescription {
  std::string name;
  std::string file;    // file name of the ONNX graph, looked up in the model folders
  std::string sha256;  // of that file, 64 hexadecimal digits
  InputDescription input;
  DecoderDescription decoder;
  std::vector<std::string> labels;  // without background
  double score_threshold = 0.35;
  double nms_iou = 0.45;
  std::string licence;
  std::string source;
  std::string fetch;  // the command that brings the file, shown when it is missing
};

/// @param source  named in messages, e.g. the file's path.
/// @throws config::ConfigError listing every violation.
NetworkDescription parse_network(const YAML::Node& node, const std::string& source);

}  // namespace rds::detector
