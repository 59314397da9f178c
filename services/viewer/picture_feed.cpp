// SPDX-License-Identifier: Apache-2.0
#include "services/viewer/picture_feed.hpp"

#include "common/messages/camera_conversions.hpp"
#include "common/topics/endpoints.hpp"
#include "services/viewer/scene_frames.hpp"

namespace rds::viewer {
namespace {

constexpr std::size_t kMostWaiting = 2;
constexpr std::size_t kMostFeatureMessages = 32;  // a second of frames

template <class Duration>
Duration period_of(double hz) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(1 / hz));
}

}  // namespace

PictureFeed::PictureFeed(service::ServiceContext& context, const ViewerServiceConfig& config, Board& board,
                         concurrency::Mailbox& mailbox, std::function<void()> notify)
    : context_(context),
      topic_(config.color_topic),
      period_(period_of<Clock::duration>(config.picture_hz)),
      board_(board),
      notify_(std::move(notify)),
      compressor_(config.picture_quality),
      images_(mailbox, kMostWaiting),
      features_(mailbox, kMostFeatureMessages) {}

void PictureFeed::set(double hz, int quality) {
  period_ = period_of<Clock::duration>(hz);
  compressor_ = keyframe_codec::JpegCompressor(quality);
}

void PictureFeed::want(bool wanted) {
  if (wanted == image_subscription_.has_value()) return;
  if (wanted) return subscribe();
  image_subscription_.reset();
  feature_subscription_.reset();
  while (images_.try_pop()) {  // what came just before would stand on the board for whoever looks next
  }
  while (features_.try_pop()) {
  }
  waiting_.clear();
  board_.remove(Kind::kPicture);
}

void PictureFeed::subscribe() {
  image_subscription_ = topics::subscribe(context_.bus, topics::kColor.named(topic_), topics::kViewer,
                                          [this](Image image) { receive(std::move(image)); });
  feature_subscription_ =
      topics::subscribe(context_.bus, topics::kFeatures, topics::kViewer, [this](Features features) {
        features_.push(std::move(features));
        notify_();
      });
}

void PictureFeed::receive(Image image) {
  const auto now = Clock::now();
  if (now - last_.load() < period_.load()) return;
  last_ = now;
  images_.push(std::move(image));
  notify_();
}

void PictureFeed::take() {
  while (auto image = images_.try_pop())
    waiting_[messages::to_nanoseconds((*image)->header().stamp())] = *image;
  while (const auto features = features_.try_pop()) {
    const auto picture = waiting_.extract(messages::to_nanoseconds((*features)->header().stamp()));
    if (!picture.empty()) put(picture.key(), picture.mapped(), features->get());
  }
  while (waiting_.size() > kMostWaiting) {  // nobody looks for features in them
    const auto oldest = waiting_.extract(waiting_.begin());
    put(oldest.key(), oldest.mapped(), nullptr);
  }
}

void PictureFeed::put(std::int64_t stamp_ns, const Image& image,
                      const rds_msgs::msg::FrameFeatures* features) {
  const auto picture = messages::camera_color(image);
  if (!picture) return context_.diagnostics.reject(topic_, service::Rejection::kInvalid, picture.error());
  const auto jpeg = compressor_.compress(*picture);
  auto frame = picture_frame(jpeg, stamp_ns, image->width(), image->height(), features);
  if (!frame)
    return context_.diagnostics.reject(topics::kFeatures.name, service::Rejection::kInvalid, frame.error());
  board_.put(Kind::kPicture, std::move(*frame));
}

}  // namespace rds::viewer
