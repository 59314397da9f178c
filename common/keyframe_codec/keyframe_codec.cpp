// SPDX-License-Identifier: Apache-2.0
#include "common/keyframe_codec/keyframe_codec.hpp"

#include <memory>
#include <utility>

#include "common/messages/image_conversions.hpp"

namespace rds::keyframe_codec {
namespace {

using rds_msgs::msg::CompressedPicture;
using rds_msgs::msg::KeyFrameCompressed;
using rds_msgs::msg::KeyFrameImages;
using sensor_msgs::msg::Image;

template <class T>
using Expected = tl::expected<T, std::string>;
using Bytes = std::vector<std::uint8_t>;

constexpr int kJpegQuality = 85;  // docs/decisions/keyframe-codec.md
constexpr const char* kJpeg = "jpeg";
constexpr const char* kPlanes = "planes_zstd";
constexpr const char* kRanks = "ranks_zstd";

/// The same message for conversions that share its ownership; it outlives them here.
std::shared_ptr<const Image> borrowed(const Image& message) {
  return {std::shared_ptr<const void>(), &message};
}

/// What KeyFrameImages and KeyFrameCompressed have in common.
template <class To, class From>
To same_keyframe(const From& from) {
  To to;
  to.header(from.header());
  to.instance(from.instance());
  to.map_epoch(from.map_epoch());
  to.keyframe_id(from.keyframe_id());
  to.frame_index(from.frame_index());
  to.submap(from.submap());
  to.map_from_camera(from.map_from_camera());
  to.camera_info(from.camera_info());
  return to;
}

Expected<void> check_size(std::uint64_t width, std::uint64_t height) {
  if (width == 0 || height == 0 || width > kLargestPicture_px || height > kLargestPicture_px / width)
    return tl::unexpected<std::string>(
        "width and height must be 1 or more, and 16777216 px together at most");
  return {};
}

CompressedPicture compressed_picture(const Image& picture, const char* format, Bytes data) {
  CompressedPicture result;
  result.header(picture.header());
  result.format(format);
  result.encoding(picture.encoding());
  result.width(picture.width());
  result.height(picture.height());
  result.data(std::move(data));
  return result;
}

Image raw_picture(const CompressedPicture& picture, Bytes data) {
  Image result;
  result.header(picture.header());
  result.width(picture.width());
  result.height(picture.height());
  result.encoding(picture.encoding());
  result.is_bigendian(0);
  if (picture.height() > 0) result.step(static_cast<std::uint32_t>(data.size() / picture.height()));
  result.data(std::move(data));
  return result;
}

const char* exact_format(int type) {
  return type == CV_16UC1 ? kRanks : kPlanes;
}

bool has_no_pixels(const Image& picture) {
  return picture.width() == 0 && picture.height() == 0 && picture.data().empty();
}

bool has_no_pixels(const CompressedPicture& picture) {
  return picture.width() == 0 && picture.height() == 0 && picture.format().empty() && picture.data().empty();
}

cv::Size size_of(const CompressedPicture& picture) {
  return {static_cast<int>(picture.width()), static_cast<int>(picture.height())};
}

Expected<CompressedPicture> compress_color(const Image& picture, JpegCompressor& jpeg) {
  const auto color = messages::to_color_image(borrowed(picture));
  if (!color) return tl::unexpected(color.error());
  return compressed_picture(picture, kJpeg, jpeg.compress(*color));
}

Expected<CompressedPicture> compress_depth(const Image& picture, LosslessCompressor& lossless) {
  const auto depth = messages::to_depth_image(borrowed(picture));
  if (!depth) return tl::unexpected(depth.error());
  return compressed_picture(picture, exact_format(depth->values.type()), lossless.compress(depth->values));
}

Expected<CompressedPicture> compress_mask(const Image& picture, cv::Size color,
                                          LosslessCompressor& lossless) {
  if (has_no_pixels(picture)) return compressed_picture(picture, "", {});
  const auto cells = messages::to_cell_mask(picture, color);
  if (!cells) return tl::unexpected(cells.error());
  return compressed_picture(picture, kPlanes, lossless.compress(*cells));
}

Expected<Image> decompress_color(const CompressedPicture& picture) {
  if (picture.format() != kJpeg) return tl::unexpected<std::string>("the format must be jpeg");
  const bool is_rgb = picture.encoding() == "rgb8";
  if (!is_rgb && picture.encoding() != "bgr8")
    return tl::unexpected<std::string>("the encoding must be rgb8 or bgr8");
  if (auto size = check_size(picture.width(), picture.height()); !size) return tl::unexpected(size.error());
  auto rows = decompress_jpeg(picture.data(), size_of(picture),
                              is_rgb ? image::ChannelOrder::kRgb : image::ChannelOrder::kBgr);
  if (!rows) return tl::unexpected(rows.error());
  return raw_picture(picture, std::move(*rows));
}

Expected<Image> decompress_exactly(const CompressedPicture& picture, int type,
                                   LosslessDecompressor& lossless) {
  if (picture.format() != exact_format(type))
    return tl::unexpected<std::string>("the format must be ranks_zstd for 16 bits, planes_zstd for others");
  if (auto size = check_size(picture.width(), picture.height()); !size) return tl::unexpected(size.error());
  auto rows = lossless.decompress(picture.data(), size_of(picture), type);
  if (!rows) return tl::unexpected(rows.error());
  return raw_picture(picture, std::move(*rows));
}

Expected<Image> decompress_depth(const CompressedPicture& picture, LosslessDecompressor& lossless) {
  const std::string& encoding = picture.encoding();
  if (encoding == "16UC1" || encoding == "mono16") return decompress_exactly(picture, CV_16UC1, lossless);
  if (encoding == "32FC1") return decompress_exactly(picture, CV_32FC1, lossless);
  return tl::unexpected<std::string>("the encoding must be 16UC1, mono16 or 32FC1");
}

Expected<Image> decompress_mask(const CompressedPicture& picture, LosslessDecompressor& lossless) {
  if (has_no_pixels(picture)) return raw_picture(picture, {});
  if (picture.encoding() != "mono8") return tl::unexpected<std::string>("the encoding must be mono8");
  return decompress_exactly(picture, CV_8UC1, lossless);
}

tl::unexpected<std::string> fault_in(const char* picture, const std::string& fault) {
  return tl::unexpected(std::string(picture) + ": " + fault);
}

}  // namespace

KeyframeCompressor::KeyframeCompressor() : jpeg_(kJpegQuality) {}

tl::expected<KeyFrameCompressed, std::string> KeyframeCompressor::compress(const KeyFrameImages& keyframe) {
  auto color = check_size(keyframe.color().width(), keyframe.color().height()).and_then([&] {
    return compress_color(keyframe.color(), jpeg_);
  });
  if (!color) return fault_in("color", color.error());
  auto depth = check_size(keyframe.depth().width(), keyframe.depth().height()).and_then([&] {
    return compress_depth(keyframe.depth(), lossless_);
  });
  if (!depth) return fault_in("depth", depth.error());
  auto movable = compress_mask(keyframe.movable(), size_of(*color), lossless_);
  if (!movable) return fault_in("movable", movable.error());
  auto result = same_keyframe<KeyFrameCompressed>(keyframe);
  result.color(std::move(*color));
  result.depth(std::move(*depth));
  result.movable(std::move(*movable));
  return result;
}

tl::expected<KeyFrameImages, std::string> KeyframeDecompressor::decompress(
    const KeyFrameCompressed& keyframe) {
  auto color = decompress_color(keyframe.color());
  if (!color) return fault_in("color", color.error());
  auto depth = decompress_depth(keyframe.depth(), lossless_);
  if (!depth) return fault_in("depth", depth.error());
  auto movable = decompress_mask(keyframe.movable(), lossless_);
  if (!movable) return fault_in("movable", movable.error());
  auto result = same_keyframe<KeyFrameImages>(keyframe);
  result.color(std::move(*color));
  result.depth(std::move(*depth));
  result.movable(std::move(*movable));
  return result;
}

}  // namespace rds::keyframe_codec
