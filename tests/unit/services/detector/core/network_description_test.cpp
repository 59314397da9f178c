// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/network_description.hpp"

#include <gmock/gmock.h>


namespace rds::detector {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kValid = R"(
name: tiny
file: tiny.onnx
sha256: 0000000000000000000000000000000000000000000000000000000000000000
input: {width: 64, height: 32, order: rgb, resize: letterbox, pad_value: 114, mean: [1, 2, 3], deviation: [4, 5, 6]}
decoder: {kind: nanodet, strides: [8, 16], bins: 8}
labels: [person, tv]
)";

std::string violations(const YAML::Node& node) {
  try {
    parse_network(node, "tiny.yaml");
    return "none";
  } catch (const config::ConfigError& e) {
    return e.what();
  }
}

TEST(NetworkDescription, ReadsEveryField) {
  const NetworkDescription n = parse_network(YAML::Load(kValid), "tiny.yaml");
  EXPECT_EQ(n.name, "tiny");
  EXPECT_EQ(n.input.width, 64);
  EXPECT_EQ(n.input.height, 32);
  EXPECT_EQ(n.input.order, InputOrder::kRgb);
  EXPECT_EQ(n.input.resize, Resize::kLetterbox);
  EXPECT_THAT(n.input.mean, ElementsAre(1, 2, 3));
  EXPECT_THAT(n.input.deviation, ElementsAre(4, 5, 6));
  EXPECT_EQ(n.decoder.kind, DecoderKind::kNanodet);
  EXPECT_THAT(n.decoder.strides, ElementsAre(8, 16));
  EXPECT_EQ(n.decoder.bins, 8);
  EXPECT_THAT(n.labels, ElementsAre("person", "tv"));
}

TEST(NetworkDescription, NamesEverythingThatIsMissing) {
  EXPECT_THAT(violations(YAML::Load("{}")),
              AllOf(HasSubstr("name"), HasSubstr("file"), HasSubstr("sha256"), HasSubstr("labels"),
                    HasSubstr("input."), HasSubstr("decoder.kind")));
}

TEST(NetworkDescription, RejectsWhatCannotBe) {
  const auto with = [](const std::string& key, const std::string& value) {
    YAML::Node node = YAML::Load(kValid);
    node[key] = YAML::Load(value);
    return violations(node);
  };
  EXPECT_THAT(with("file", "../secret.onnx"),
              HasSubstr("file: ../secret.onnx, expected a file name without a folder"));
  EXPECT_THAT(with("sha256", "12ab"), HasSubstr("64 hexadecimal digits"));
  EXPECT_THAT(with("score_threshold", "7"), HasSubstr("score_threshold"));
  EXPECT_THAT(with("input", "{width: 64, height: 64, deviation: [0, 1, 1]}"), HasSubstr("input.deviation"));
  EXPECT_THAT(with("input", "{width: 64, height: 64, mean: [1]}"), HasSubstr("expected 3 numbers"));
  EXPECT_THAT(with("input", "{width: 100000, height: 64}"), HasSubstr("input.width"));
  EXPECT_THAT(with("decoder", "{kind: yolox, strides: [0]}"), HasSubstr("decoder.strides"));
  EXPECT_THAT(with("decoder", "{kind: nanodet, strides: [8]}"), HasSubstr("decoder.bins"));
  EXPECT_THAT(with("decoder", "{kind: ssd, cells: [19], min_sizes: [60, 70]}"), HasSubstr("decoder.cells"));
  EXPECT_THAT(with("decoder", "{kind: magic}"), HasSubstr("decoder.kind"));
  EXPECT_THAT(with("typo", "1"), HasSubstr("typo: unknown key"));
}

}  // namespace
}  // namespace rds::detector
