// SPDX-License-Identifier: Apache-2.0
#include "services/tracker/input/camera_faults.hpp"

#include <gmock/gmock.h>

namespace rds::tracker {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using std::chrono_literals::operator""ms;

/// All is well: everything comes.
CameraSight working_camera() {
  return {.color = {.topic = "color", .publishers = 1, .silent_s = 0.03},
          .info = {.topic = "info", .publishers = 1, .silent_s = 0.03},
          .depth = {.topic = "depth", .publishers = 1, .silent_s = 0.03},
          .since_frame_s = 0.03};
}

TEST(CameraFaults, AreNoneOfACameraThatWorksOrIsNotThere) {
  EXPECT_THAT(camera_faults(working_camera()), IsEmpty());
  EXPECT_THAT(
      camera_faults({.color = {.topic = "color"}, .info = {.topic = "info"}, .depth = {.topic = "depth"}}),
      IsEmpty());
}

TEST(CameraFaults, AreNoneOfADriverThatDoesNothingYet) {
  CameraSight sight = working_camera();
  for (StreamSight* stream : {&sight.color, &sight.info, &sight.depth})
    stream->silent_s = StreamSight::kNever;
  EXPECT_THAT(camera_faults(sight), IsEmpty());
}

TEST(CameraFaults, NameOtherTopicsOfPictures) {
  CameraSight sight = working_camera();
  sight.color = {.topic = "color"};
  sight.other_pictures = {"camera/rgb/image_raw", "camera/ir/image_raw"};
  EXPECT_THAT(camera_faults(sight),
              ElementsAre(Pair("camera colour",
                               AllOf(HasSubstr("nobody publishes color"), HasSubstr("camera/rgb/image_raw"),
                                     HasSubstr("set camera.preset to xtion, or camera.color")))));
  sight.other_pictures.push_back("camera/depth_registered/image_raw");
  EXPECT_THAT(camera_faults(sight)["camera colour"], HasSubstr("set camera.preset to kinect_v1, or"));
}

TEST(CameraFaults, NameTheTypeThatIsNotRead) {
  CameraSight sight = working_camera();
  sight.color = {.topic = "color", .other_type = "sensor_msgs::msg::dds_::CompressedImage_"};
  EXPECT_THAT(camera_faults(sight)["camera colour"],
              AllOf(HasSubstr("CompressedImage"), HasSubstr("camera.color")));
}

TEST(CameraFaults, TellWhyPicturesAreRefused) {
  CameraSight sight = working_camera();
  sight.color.silent_s = 5;
  sight.color.refused_s = 0.03;
  sight.color.refusal = "image encoding 'nv21', expected one of rgb8";
  EXPECT_THAT(camera_faults(sight),
              ElementsAre(Pair("camera colour", "color: image encoding 'nv21', expected one of rgb8")));
}

TEST(CameraFaults, TellOfMissingCameraInfo) {
  CameraSight sight = working_camera();
  sight.info = {.topic = "info"};
  sight.other_infos = {"camera/rgb/camera_info"};
  EXPECT_THAT(camera_faults(sight)["camera info"],
              AllOf(HasSubstr("nobody publishes info"), HasSubstr("camera/rgb/camera_info"),
                    HasSubstr("camera.camera_info")));
  sight.info.silent_s = 100;
  EXPECT_FALSE(camera_faults(sight).contains("camera info")) << "it came once, which is enough";
}

TEST(CameraFaults, TellOfMissingDepth) {
  CameraSight sight = working_camera();
  sight.depth = {.topic = "depth"};
  EXPECT_THAT(camera_faults(sight)["camera depth"],
              AllOf(HasSubstr("nobody publishes depth"), HasSubstr("align_depth.enable:=true")));
  sight.depth = {.topic = "depth", .publishers = 1, .silent_s = 3};
  EXPECT_THAT(camera_faults(sight)["camera depth"], HasSubstr("has a publisher, but nothing comes"));
}

TEST(CameraFaults, TellOfPicturesWithoutPartner) {
  CameraSight sight = working_camera();
  sight.since_frame_s = 1;
  sight.partner_ms = 45;
  EXPECT_THAT(camera_faults(sight)["camera pairing"],
              AllOf(HasSubstr("45 ms apart"), HasSubstr("camera.pairing_tolerance_s")));
}

TEST(CameraFaults, HaveNamesThatAreKnown) {
  CameraSight sight = working_camera();
  sight.info = {.topic = "info"};
  sight.depth = {.topic = "depth"};
  for (const auto& [name, text] : camera_faults(sight)) EXPECT_THAT(kCameraFaults, ::testing::Contains(name));
}

TEST(FaultFilter, WaitsUntilAFaultLasts) {
  FaultFilter filter;
  const FaultFilter::Time start;
  EXPECT_THAT(filter.lasting({{"a", "text"}}, start), IsEmpty());
  EXPECT_THAT(filter.lasting({{"a", "text"}}, start + 250ms), IsEmpty());
  EXPECT_THAT(filter.lasting({{"a", "another"}}, start + 500ms), ElementsAre(Pair("a", "another")));
  EXPECT_THAT(filter.lasting({}, start + 600ms), IsEmpty());
  EXPECT_THAT(filter.lasting({{"a", "text"}}, start + 700ms), IsEmpty()) << "it begins again";
}

}  // namespace
}  // namespace rds::tracker
