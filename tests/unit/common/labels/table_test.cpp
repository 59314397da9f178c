// SPDX-License-Identifier: Apache-2.0
#include "common/labels/table.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "services/detector/models/model_store.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rds::labels {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class UsersTable : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    std::ofstream(folder_ / "labels.yaml") << text;
    return (folder_ / "labels.yaml").string();
  }
  test::TemporaryFolder folder_;
};

TEST(ShippedTable, KnowsEveryLabelOfTheShippedNetworks) {
  const Table table;
  for (const auto& network : detector::shipped_networks())
    for (const std::string& label : network.labels)
      EXPECT_NE(table.find(label), nullptr) << network.name << ": " << label;
}

TEST(ShippedTable, HasPeopleAndAnimalsAsMovable) {
  const Table table;
  for (const auto* label : {"person", "cat", "dog", "bird", "horse", "sheep", "cow"})
    EXPECT_TRUE(table[label].movable) << label;
  for (const auto* label : {"chair", "tv", "backpack", "car", "no such label"})
    EXPECT_FALSE(table[label].movable);
}

TEST(ShippedTable, SpellsLabelsAsVocDoes) {
  const Table table;
  EXPECT_EQ(table.name_of("tv"), "tvmonitor");
  EXPECT_EQ(table.name_of("couch"), "sofa");
  EXPECT_EQ(table.name_of("potted plant"), "pottedplant");
  EXPECT_EQ(table.name_of("dining table"), "diningtable");
  EXPECT_EQ(table.name_of("motorcycle"), "motorbike");
  EXPECT_EQ(table.name_of("airplane"), "aeroplane");
  EXPECT_EQ(table.name_of("person"), "person");
  EXPECT_EQ(table.name_of("teddy bear"), "teddy bear");
}

TEST(ShippedTable, GivesSizesByLabelOrAlias) {
  const Table table;
  EXPECT_EQ(table["person"].thickness_m, 0.6);
  EXPECT_EQ(table["bottle"].thickness_m, 0.1);
  EXPECT_EQ(table["no such label"].thickness_m, 0.4);
  EXPECT_EQ(table["tv"].radius_m, 0.25);
  EXPECT_EQ(table["sofa"].radius_m, 0.6);
}

TEST_F(UsersTable, AddsAndRedefines) {
  Table table;
  table.add(
      file("labels: {human: {movable: true, thickness_m: 0.5, aliases: [man]}, person: {movable: false}}"));
  EXPECT_TRUE(table["man"].movable);
  EXPECT_EQ(table["human"].thickness_m, 0.5);
  EXPECT_FALSE(table["person"].movable);
  EXPECT_TRUE(table["person"].color.has_value()) << "colours stay those of the shipped table";
  EXPECT_TRUE(table["dog"].movable);
}

TEST_F(UsersTable, IsRefusedWithAllThatIsWrong) {
  const std::string path = file("labels: {human: {movble: true, thickness_m: -1}, box: {color: [1, 2, 3]}}");
  config::ConfigReader reader(YAML::Load("{labels_file: " + path + "}"), "service.yaml");
  Table table;
  read(reader, table);
  try {
    reader.finish();
    FAIL() << "no violation found";
  } catch (const config::ConfigError& e) {
    EXPECT_THAT(
        e.what(),
        AllOf(HasSubstr("service.yaml: labels_file"), HasSubstr("labels.human.thickness_m: -1"),
              HasSubstr("labels.human.movble: unknown key"), HasSubstr("labels.box.color: unknown key")));
  }
}

}  // namespace
}  // namespace rds::labels
