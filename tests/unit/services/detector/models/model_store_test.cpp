// SPDX-License-Identifier: Apache-2.0
#include "services/detector/models/model_store.hpp"

#include <cstdlib>

#include <gmock/gmock.h>

#include "services/detector/models/file_digest.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::detector {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// An empty folder of its own for each test, and environment variables that are put back.
class ModelStore : public ::testing::Test {
 protected:
  ~ModelStore() override {
    for (const auto& [name, value] : before_) value ? setenv(name, value->c_str(), 1) : unsetenv(name);
  }
  void set(const char* name, const char* value) {
    const char* old = std::getenv(name);
    before_.emplace_back(name, old == nullptr ? std::nullopt : std::optional<std::string>(old));
    value == nullptr ? unsetenv(name) : setenv(name, value, 1);
  }
  void write(const std::string& name, const std::string& content) const {
    rds::test::write_text(temporary_ / name, content);
  }

  rds::test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

std::string error_of(const std::string& name, const ModelFolders& folders) {
  try {
    static_cast<void>(load_network(name, folders));
    return "none";
  } catch (const DetectorError& e) {
    return e.what();
  }
}

TEST_F(ModelStore, LooksInTheGivenFolderThenInTheSharedOneThenInTheCache) {
  set("RDS_SHARED", "/shared");
  set("XDG_CACHE_HOME", "/cache");
  EXPECT_THAT(model_folders("/mine"), ElementsAre("/mine", "/shared/models", "/cache/rds-slam/models"));
  set("RDS_SHARED", nullptr);
  set("XDG_CACHE_HOME", nullptr);
  set("HOME", "/home/somebody");
  EXPECT_THAT(model_folders(), ElementsAre("/home/somebody/.cache/rds-slam/models"));
  set("HOME", nullptr);
  EXPECT_THAT(model_folders(), IsEmpty());
}

TEST_F(ModelStore, KnowsTheShippedNetworks) {
  const auto networks = shipped_networks();
  for (const auto* name : {"mobilenetv2_ssdlite_voc", "nanodet_g", "nanodet_m_320", "yolox_nano"})
    EXPECT_THAT(networks, Contains(Field(&NetworkDescription::name, name)));
  for (const NetworkDescription& network : networks) {
    EXPECT_THAT(network.labels, Contains("person")) << network.name;
    EXPECT_FALSE(network.licence.empty()) << network.name;
    EXPECT_FALSE(network.source.empty()) << network.name;
    EXPECT_EQ(network.labels.size(), network.decoder.kind == DecoderKind::kSsd ? 20U : 80U) << network.name;
  }
}

TEST_F(ModelStore, DefaultsToThePapersNetworkWhereItIsFound) {
  EXPECT_EQ(default_network({folder_}), "nanodet_g");
  write("mobilenetv2_ssdlite_voc.onnx", "anything");
  EXPECT_EQ(default_network({folder_}), "mobilenetv2_ssdlite_voc");
}

TEST_F(ModelStore, SaysWhereAMissingFileWasLookedForAndWhatBringsIt) {
  EXPECT_THAT(error_of("nanodet_g", {folder_}),
              AllOf(HasSubstr("nanodet_g_416x320.onnx was not found in " + folder_.string()),
                    HasSubstr("rds models fetch nanodet_g")));
  EXPECT_THAT(error_of("yolox_nano", {folder_}), HasSubstr("--model-dir"));
}

TEST_F(ModelStore, RefusesAnAlteredFile) {
  write("nanodet_g_416x320.onnx", "altered");
  EXPECT_THAT(error_of("nanodet_g", {folder_}),
              AllOf(HasSubstr((folder_ / "nanodet_g_416x320.onnx").string()), HasSubstr("expected SHA-256")));
}

TEST_F(ModelStore, RefusesAnEmptyFile) {
  write("nanodet_g_416x320.onnx", "");
  EXPECT_THAT(error_of("nanodet_g", {folder_}), HasSubstr("cannot be read"));
}

TEST_F(ModelStore, NamesTheNetworksItKnows) {
  EXPECT_THAT(error_of("resnet", {folder_}), AllOf(HasSubstr("network 'resnet'"), HasSubstr("nanodet_g")));
}

TEST_F(ModelStore, ReadsADescriptionOfOnesOwn) {
  const std::string content = "not really a network";
  const std::string digest =
      sha256_hex({reinterpret_cast<const unsigned char*>(content.data()), content.size()});
  write("own.onnx", content);
  write("own.yaml",
        "{name: own, file: own.onnx, sha256: " + digest +
            ", input: {width: 8, height: 8}, decoder: {kind: yolox, strides: [8]}, labels: [person]}");
  EXPECT_EQ(load_network("own", {folder_}).weights.size(), content.size());
  EXPECT_EQ(load_network((folder_ / "own.yaml").string(), {folder_}).description.name, "own");
}

TEST_F(ModelStore, NamesFileAndLineOfWhatIsNoYaml) {
  write("own.yaml", "name: own\nfile: [unclosed\n");
  EXPECT_THAT(error_of("own", {folder_}), HasSubstr("own.yaml:"));
}

TEST(FileDigest, IsSha256) {
  const std::string abc = "abc";
  EXPECT_EQ(sha256_hex({reinterpret_cast<const unsigned char*>(abc.data()), abc.size()}),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace rds::detector
