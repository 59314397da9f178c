// SPDX-License-Identifier: Apache-2.0
// Time and bytes of keyframes between machines, on the recordings that there are: those of RDS_SHARED, and
// those that fixtures of the tests make, if RDS_RECORDINGS names their folder. Counters are medians over the
// pictures.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <benchmark/benchmark.h>

#include "common/image/tum_dataset.hpp"
#include "common/keyframe_codec/keyframe_codec.hpp"
#include "common/messages/image_conversions.hpp"
#include "tests/bench/keyframe_codec/depth_alternatives.hpp"
#include "tests/bench/keyframe_codec/jpeg_of.hpp"

namespace {

using namespace rds;
using rds_msgs::msg::KeyFrameCompressed;
using rds_msgs::msg::KeyFrameImages;
using Keyframes = std::vector<KeyFrameImages>;

constexpr std::size_t kPictures = 40;  // of a recording, evenly

Keyframes keyframes_of(const std::filesystem::path& folder) {
  const auto dataset = image::TumDataset::open(folder);
  if (!dataset) throw std::runtime_error(dataset.error());
  const std::size_t step = std::max<std::size_t>(dataset->frames().size() / kPictures, 1);
  Keyframes keyframes;
  for (std::size_t i = 0; i < dataset->frames().size(); i += step) {
    const auto frame = dataset->load(dataset->frames()[i]);
    if (!frame) throw std::runtime_error(frame.error());
    const auto header = messages::make_header(frame->stamp_ns, "camera");
    keyframes.emplace_back().color(messages::to_image_message(frame->color, header));
    keyframes.back().depth(messages::to_image_message(frame->depth, header));
  }
  return keyframes;
}

cv::Mat pixels_of(const sensor_msgs::msg::Image& picture, int type) {
  return {static_cast<int>(picture.height()), static_cast<int>(picture.width()), type,
          const_cast<std::uint8_t*>(picture.data().data())};
}

/// What a keyframe takes in each of a cycle of them.
class Sizes {
 public:
  void add(std::size_t bytes) { kilobytes_.push_back(static_cast<double>(bytes) / 1000); }
  void report(benchmark::State& state, const std::string& name) {
    if (kilobytes_.empty()) return;
    std::ranges::sort(kilobytes_);
    state.counters[name + "_kB"] = kilobytes_[kilobytes_.size() / 2];
    state.counters[name + "_kB_max"] = kilobytes_.back();
  }

 private:
  std::vector<double> kilobytes_;
};

void compress(benchmark::State& state, const Keyframes& keyframes) {
  keyframe_codec::KeyframeCompressor compressor;
  Sizes color;
  Sizes depth;
  std::size_t i = 0;
  for (auto _ : state) {
    const auto small = compressor.compress(keyframes[i++ % keyframes.size()]);
    color.add(small->color().data().size());
    depth.add(small->depth().data().size());
  }
  color.report(state, "color");
  depth.report(state, "depth");
}

void decompress(benchmark::State& state, const Keyframes& keyframes) {
  keyframe_codec::KeyframeCompressor compressor;
  std::vector<KeyFrameCompressed> small;
  for (const auto& keyframe : keyframes) small.push_back(*compressor.compress(keyframe));
  keyframe_codec::KeyframeDecompressor decompressor;
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(decompressor.decompress(small[i++ % small.size()]));
}

void compress_color(benchmark::State& state, const Keyframes& keyframes, int quality,
                    const bench::Subsampling& subsampling) {
  Sizes sizes;
  std::size_t i = 0;
  for (auto _ : state) {
    const cv::Mat pixels = pixels_of(keyframes[i++ % keyframes.size()].color(), CV_8UC3);
    sizes.add(bench::jpeg_of(pixels, quality, subsampling).size());
  }
  sizes.report(state, "color");
}

void compress_metres(benchmark::State& state, const Keyframes& keyframes) {
  std::vector<cv::Mat> metres(keyframes.size());
  for (std::size_t i = 0; i < metres.size(); ++i)
    pixels_of(keyframes[i].depth(), CV_16UC1).convertTo(metres[i], CV_32F, 0.001);
  keyframe_codec::LosslessCompressor compressor;
  Sizes sizes;
  std::size_t i = 0;
  for (auto _ : state) sizes.add(compressor.compress(metres[i++ % metres.size()]).size());
  sizes.report(state, "depth");
}

void compress_depth(benchmark::State& state, const Keyframes& keyframes, const bench::DepthAlternative& way) {
  Sizes sizes;
  std::size_t i = 0;
  for (auto _ : state)
    sizes.add(way.compress(pixels_of(keyframes[i++ % keyframes.size()].depth(), CV_16UC1)).size());
  sizes.report(state, "depth");
}

void decompress_depth(benchmark::State& state, const Keyframes& keyframes,
                      const bench::DepthAlternative& way) {
  std::vector<std::vector<std::uint8_t>> data;
  for (const auto& keyframe : keyframes) {
    const cv::Mat depth = pixels_of(keyframe.depth(), CV_16UC1);
    data.push_back(way.compress(depth));
    if (cv::norm(way.decompress(data.back(), depth.size()), depth, cv::NORM_INF) != 0)
      return state.SkipWithError("another picture came back");
  }
  const cv::Size size = pixels_of(keyframes.front().depth(), CV_16UC1).size();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(way.decompress(data[i++ % data.size()], size));
}

std::vector<std::filesystem::path> recordings() {
  std::vector<std::filesystem::path> all;
  const auto add = [&](const char* variable, const std::string& name) {
    const char* folder = std::getenv(variable);
    if (folder == nullptr) return;
    const auto path = std::filesystem::path(folder) / name;
    if (std::filesystem::exists(path / "rgb.txt")) all.push_back(path);
  };
  for (const char* name : {"data/7scenes_kitchen", "data/tum_fr1_rpy"}) add("RDS_SHARED", name);
  for (const char* name : {"kitchen_walkers", "fr1_walkers", "kitchen_crowd", "room"})
    add("RDS_RECORDINGS", name);
  return all;
}

template <class Function, class... Arguments>
void add(const std::string& name, Function function, Arguments... arguments) {
  benchmark::RegisterBenchmark(name.c_str(), function, arguments...)->Unit(benchmark::kMillisecond);
}

/// Recordings are known at run time only.
const bool kRegistered = [] {
  static std::vector<Keyframes> all;
  const auto folders = recordings();
  all.reserve(folders.size());
  for (const auto& folder : folders) {
    const Keyframes& keyframes = all.emplace_back(keyframes_of(folder));
    const std::string name = folder.filename().string();
    add("compress/" + name, compress, std::cref(keyframes));
    add("decompress/" + name, decompress, std::cref(keyframes));
    for (const int quality : {80, 85, 90, 95})
      for (const auto& subsampling : bench::kSubsamplings)
        add("color/" + name + "/" + std::to_string(quality) + "/" + subsampling.name, compress_color,
            std::cref(keyframes), quality, subsampling);
    add("metres/" + name, compress_metres, std::cref(keyframes));
    for (const auto& way : bench::depth_alternatives()) {
      add("depth/" + name + "/" + way.name, compress_depth, std::cref(keyframes), way);
      add("depth_back/" + name + "/" + way.name, decompress_depth, std::cref(keyframes), way);
    }
  }
  return true;
}();

}  // namespace
