// SPDX-License-Identifier: Apache-2.0
// Whole runs on a bag whose depth camera stands apart from colour's, of half its size, as tf_static says: as
// good as depth that the driver has registered, and the same as a folder that is made of the bag.
#include <gmock/gmock.h>

#include "common/bus/type_ops.hpp"
#include "common/image/tum_dataset.hpp"
#include "common/messages/conversions.hpp"
#include "common/messages/image_conversions.hpp"
#include "tests/integration/camera/camera_driver.hpp"
#include "tests/integration/run_support.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/small_dataset.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/recording/conversion.hpp"

namespace rds::test {
namespace {

using messages::make_header;

constexpr std::size_t kFrames = 90;
constexpr double kMostLoss = 1.3;  // of ATE; depth has a quarter of the measurements, …
constexpr double kSameM = 0.002;   // … or as near as that
const std::string kColorFrame = "camera_color_optical_frame";
const std::string kDepthFrame = "camera_depth_optical_frame";

/// Messages into a bag, each topic once.
class BagOfMessages {
 public:
  explicit BagOfMessages(const std::filesystem::path& file)
      : writer_(recording::make_bag_writer(file, mcap::Compression::kLz4).value()) {}
  template <class Message>
  void add(const std::string& topic, const Message& message, std::int64_t stamp_ns) {
    const auto& type = bus::type_ops<Message>();
    if (!numbers_.contains(topic))
      numbers_[topic] = writer_->add_topic(recording::topic_of(topic, type, "")).value();
    recording::Bytes bytes(type.encoded_size(&message));
    bytes.resize(type.encode(&message, bytes.data(), bytes.size()));
    ASSERT_TRUE(writer_->write(numbers_[topic], {stamp_ns, stamp_ns, bytes}));
  }
  void finish() { ASSERT_TRUE(writer_->finish()); }

 private:
  std::unique_ptr<recording::BagWriter> writer_;
  std::map<std::string, std::size_t> numbers_;
};

tf2_msgs::msg::TFMessage mounting() {
  geometry_msgs::msg::TransformStamped transform;
  transform.header(make_header(0, kColorFrame));
  transform.child_frame_id(kDepthFrame);
  transform.transform(messages::to_transform_message(color_from_depth()));
  tf2_msgs::msg::TFMessage tree;
  tree.transforms().push_back(transform);
  return tree;
}

/// As realsense2_camera publishes without align_depth.
void write_robot_bag(const image::TumDataset& recording, const std::filesystem::path& file) {
  BagOfMessages bag(file);
  const geometry::CameraModel half = half_of(recording.camera());
  bag.add("/tf_static", mounting(), recording.frames().front().stamp_ns);
  for (const auto& ref : recording.frames()) {
    const auto frame = recording.load(ref).value();
    const std::int64_t ns = ref.stamp_ns;
    bag.add("/camera/color/camera_info", messages::to_camera_info(frame.camera, make_header(ns, kColorFrame)),
            ns);
    bag.add("/camera/color/image_raw", messages::to_image_message(frame.color, make_header(ns, kColorFrame)),
            ns);
    bag.add("/camera/depth/camera_info", messages::to_camera_info(half, make_header(ns, kDepthFrame)), ns);
    bag.add("/camera/depth/image_rect_raw",
            messages::to_image_message(seen_from_depth(frame, half), make_header(ns, kDepthFrame)), ns);
  }
  bag.finish();
}

TEST(DepthApartRun, IsAsGoodAsRegisteredDepthAndAsAFolderMadeOfIt) {
  const TemporaryFolder place;
  make_excerpt(recording_of_a_room().folder, place / "registered", kFrames);
  write_robot_bag(image::TumDataset::open(place / "registered").value(), place / "apart.mcap");
  Process convert({rds(), "convert", (place / "apart.mcap").string(), (place / "converted").string()});
  ASSERT_EQ(convert.wait(std::chrono::seconds(60)), 0) << convert.standard_error();
  for (const auto& [dataset, bus] :
       {std::pair("registered", "fastdds"), std::pair("apart.mcap", "cyclonedds"),
        std::pair("converted", "fastdds")}) {
    const auto result = run(place / dataset, place / (std::string(dataset) + "_out"),
                            {"--rate", "max", "--no-dynamics", "--bus", bus});
    ASSERT_EQ(result.status, 0) << result.standard_error;
  }
  const auto ate_m = [&](const std::string& out) {
    return score(place / "registered", place / out)["ate_final"].get<double>();
  };
  EXPECT_LE(ate_m("apart.mcap_out"),
            std::max(kMostLoss * ate_m("registered_out"), ate_m("registered_out") + kSameM));
  for (const char* file : {"trajectory.txt", "map.ot"})
    EXPECT_EQ(read_text(place / "apart.mcap_out" / file), read_text(place / "converted_out" / file)) << file;
}

}  // namespace
}  // namespace rds::test
