// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/decoder.hpp"

#include <fmt/format.h>

#include "services/detector/core/detection.hpp"

namespace rds::detector {

std::unique_ptr<Decoder> make_decoder(const NetworkDescription& network) {
  switch (network.decoder.kind) {
    case DecoderKind::kSsd:
      return make_ssd_decoder(network);
    case DecoderKind::kYolox:
      return make_yolox_decoder(network);
    case DecoderKind::kNanodet:
      return make_nanodet_decoder(network);
  }
  throw std::invalid_argument("unknown kind of decoder");
}

cv::Mat as_rows(const NamedTensor& tensor, int columns) {
  const auto values = static_cast<int>(tensor.values.total());
  if (tensor.values.type() != CV_32F || !tensor.values.isContinuous() || values == 0 || values % columns != 0)
    throw DetectorError(fmt::format("output '{}' of the network: expected rows of {} values, got {} values",
                                    tensor.name, columns, values));
  return tensor.values.reshape(1, std::vector<int>{values / columns, columns});
}

}  // namespace rds::detector
