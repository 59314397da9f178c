// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/mjpeg_avi.hpp"

#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace rds::run {
namespace {

// Source: Microsoft, "AVI RIFF File Reference" (structures MainAVIHeader, AVISTREAMHEADER, BITMAPINFOHEADER,
// idx1).
constexpr std::uint32_t kHasIndex = 0x10;
constexpr std::uint32_t kKeyframe = 0x10;
constexpr std::uint32_t kMainHeaderBytes = 56;
constexpr std::uint32_t kStreamHeaderBytes = 56;
constexpr std::uint32_t kFormatBytes = 40;
constexpr std::uint32_t kStreamListBytes = 4 + 8 + kStreamHeaderBytes + 8 + kFormatBytes;
constexpr std::uint32_t kHeaderListBytes = 4 + 8 + kMainHeaderBytes + 8 + kStreamListBytes;
constexpr std::uint32_t kRateScale = 1000;

void tag(std::ostream& out, std::string_view four) {
  out.write(four.data(), 4);
}

void u16(std::ostream& out, std::uint32_t value) {
  out.put(static_cast<char>(value & 0xFF)).put(static_cast<char>(value >> 8 & 0xFF));
}

void u32(std::ostream& out, std::uint32_t value) {
  u16(out, value & 0xFFFF);
  u16(out, value >> 16);
}

void zeros(std::ostream& out, int words) {
  for (int i = 0; i < words; ++i) u32(out, 0);
}

}  // namespace

MjpegAvi::MjpegAvi(const std::filesystem::path& file, double frames_per_second)
    : file_(file), out_(file, std::ios::binary), frames_per_second_(frames_per_second) {}

MjpegAvi::~MjpegAvi() {
  try {
    close();
  } catch (const std::exception&) {  // of a run that was broken off
  }
}

void MjpegAvi::add(const cv::Mat& bgr) {
  if (offsets_.empty()) {
    size_ = bgr.size();
    write_header(0);
  }
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", bgr, jpeg, {cv::IMWRITE_JPEG_QUALITY, 85});
  offsets_.push_back(movi_bytes_);
  sizes_.push_back(static_cast<std::uint32_t>(jpeg.size()));
  if (jpeg.size() % 2 != 0) jpeg.push_back(0);
  tag(out_, "00dc");
  u32(out_, sizes_.back());
  out_.write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
  movi_bytes_ += 8 + static_cast<std::uint32_t>(jpeg.size());
}

void MjpegAvi::close() {
  if (closed_ || offsets_.empty()) return;
  closed_ = true;
  tag(out_, "idx1");
  u32(out_, static_cast<std::uint32_t>(16 * offsets_.size()));
  for (std::size_t i = 0; i < offsets_.size(); ++i) {
    tag(out_, "00dc");
    u32(out_, kKeyframe);
    u32(out_, offsets_[i]);
    u32(out_, sizes_[i]);
  }
  out_.seekp(0);
  write_header(movi_bytes_ + 8 + static_cast<std::uint32_t>(16 * offsets_.size()));
  out_.close();
  if (!out_) throw std::runtime_error(fmt::format("{}: cannot be written", file_.string()));
}

void MjpegAvi::write_header(std::uint32_t data_bytes) {
  const auto frames = static_cast<std::uint32_t>(offsets_.size());
  const auto width = static_cast<std::uint32_t>(size_.width);
  const auto height = static_cast<std::uint32_t>(size_.height);
  const auto rate = static_cast<std::uint32_t>(std::lround(frames_per_second_ * kRateScale));
  tag(out_, "RIFF"), u32(out_, 4 + 8 + kHeaderListBytes + 8 + data_bytes), tag(out_, "AVI ");
  tag(out_, "LIST"), u32(out_, kHeaderListBytes), tag(out_, "hdrl");
  tag(out_, "avih"), u32(out_, kMainHeaderBytes);
  u32(out_, static_cast<std::uint32_t>(std::lround(1e6 / frames_per_second_))), zeros(out_, 2),
      u32(out_, kHasIndex);
  u32(out_, frames), u32(out_, 0), u32(out_, 1), u32(out_, width * height * 3), u32(out_, width),
      u32(out_, height);
  zeros(out_, 4);
  tag(out_, "LIST"), u32(out_, kStreamListBytes), tag(out_, "strl");
  tag(out_, "strh"), u32(out_, kStreamHeaderBytes), tag(out_, "vids"), tag(out_, "MJPG"), zeros(out_, 3);
  u32(out_, kRateScale), u32(out_, rate), u32(out_, 0), u32(out_, frames), u32(out_, width * height * 3);
  u32(out_, 0xFFFFFFFF), u32(out_, 0), u16(out_, 0), u16(out_, 0), u16(out_, width), u16(out_, height);
  tag(out_, "strf"), u32(out_, kFormatBytes), u32(out_, kFormatBytes), u32(out_, width), u32(out_, height);
  u16(out_, 1), u16(out_, 24), tag(out_, "MJPG"), u32(out_, width * height * 3), zeros(out_, 4);
  tag(out_, "LIST"), u32(out_, movi_bytes_), tag(out_, "movi");
}

}  // namespace rds::run
