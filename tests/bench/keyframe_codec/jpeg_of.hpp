// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include <opencv2/core.hpp>
#include <turbojpeg.h>

namespace rds::bench {

/// Of colour, as TurboJPEG counts.
struct Subsampling {
  const char* name;
  int kind;
};
constexpr std::array<Subsampling, 3> kSubsamplings{
    {{"4:2:0", TJSAMP_420}, {"4:2:2", TJSAMP_422}, {"4:4:4", TJSAMP_444}}};

inline std::vector<std::uint8_t> jpeg_of(const cv::Mat& bgr, int quality, const Subsampling& subsampling) {
  const std::unique_ptr<void, int (*)(tjhandle)> handle(tjInitCompress(), tjDestroy);
  std::vector<std::uint8_t> jpeg(tjBufSize(bgr.cols, bgr.rows, subsampling.kind));
  unsigned char* out = jpeg.data();
  unsigned long size = jpeg.size();
  if (tjCompress2(handle.get(), bgr.data, bgr.cols, static_cast<int>(bgr.step), bgr.rows, TJPF_BGR, &out,
                  &size, subsampling.kind, quality, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) != 0)
    throw std::runtime_error(tjGetErrorStr2(handle.get()));
  jpeg.resize(size);
  return jpeg;
}

}  // namespace rds::bench
