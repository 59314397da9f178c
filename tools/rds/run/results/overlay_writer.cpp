// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/run/results/overlay_writer.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "common/messages/conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "tools/rds/run/output/result_file.hpp"
#include "tools/rds/run/results/overlay.hpp"

namespace rds::run {
namespace {
constexpr std::size_t kEvery = 50;
constexpr std::size_t kMaxWaiting = 200;
constexpr int kJpegQuality = 90;
constexpr std::chrono::milliseconds kRecordLimit{1000};
}  // namespace

OverlayWriter::OverlayWriter(bus::Participant& bus, Recorder& recorder, std::filesystem::path folder,
                             bool video, double frames_per_second)
    : recorder_(recorder),
      folder_(std::move(folder)),
      video_(video ? std::make_unique<MjpegAvi>(folder_ / "overlay.avi", frames_per_second) : nullptr),
      features_(mailbox_, kMaxWaiting),
      subscription_(topics::subscribe(bus, topics::kFeatures, topics::kPlayer,
                                      [this](Features m) { features_.push(std::move(m)); })),
      thread_([this](const std::stop_token& stop) { draw_all(stop); }) {
  std::filesystem::create_directories(folder_ / "overlay");
}

void OverlayWriter::add_picture(std::size_t index, const image::RgbdFrame& frame) {
  if (!video_ && index % kEvery != 0) return;
  const std::lock_guard lock(mutex_);
  pictures_[frame.stamp_ns] = {index, frame.color};
  if (pictures_.size() > kMaxWaiting) pictures_.erase(pictures_.begin());
}

std::optional<OverlayWriter::Picture> OverlayWriter::take_picture(std::int64_t stamp_ns) {
  const std::lock_guard lock(mutex_);
  auto node = pictures_.extract(stamp_ns);
  if (node.empty()) return std::nullopt;
  return std::move(node.mapped());
}

void OverlayWriter::draw_all(const std::stop_token& stop) {
  const auto draw_waiting = [this] {
    while (const auto features = features_.try_pop())
      if (!failure_) draw_or_fail(*features);
  };
  while (mailbox_.wait(stop, [this] { return !features_.locked_empty(); })) draw_waiting();
  draw_waiting();
}

void OverlayWriter::draw_or_fail(const Features& features) {
  try {
    draw(features);
  } catch (const std::exception&) {
    failure_ = std::current_exception();
  }
}

void OverlayWriter::draw(const Features& features) {
  const std::int64_t stamp_ns = messages::to_nanoseconds(features->header().stamp());
  recorder_.wait_acknowledged(stamp_ns, {}, kRecordLimit);
  const auto picture = take_picture(stamp_ns);
  const auto frame = recorder_.frame(stamp_ns);
  if (!picture || !frame) return;
  const cv::Mat drawn =
      draw_overlay(picture->color.bgr(), *features, recorder_.predictions(stamp_ns), *frame);
  if (video_) video_->add(drawn);
  if (picture->index % kEvery == 0)
    write_picture(folder_ / "overlay" / fmt::format("{:06}.jpg", picture->index), drawn,
                  {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
}

void OverlayWriter::finish() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  if (video_) video_->close();
}

}  // namespace rds::run
