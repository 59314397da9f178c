// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/secure/secure_folder.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "common/bus/security.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/rds/secure/roles.hpp"

namespace rds::secure {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Clock = std::chrono::system_clock;

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 0777U : 0;
}

class SecureFolder : public ::testing::Test {
 protected:
  fs::path make(const std::string& name, Clock::time_point now = Clock::now()) {
    const auto made = make_secure_folder(place_ / name, {.validity = ten_years(now)});
    EXPECT_TRUE(made) << made.error();
    return place_ / name;
  }
  /// Why the tracker's credentials are refused; empty if they are accepted.
  static std::string refusal(const fs::path& folder, Clock::time_point now = Clock::now()) {
    const auto read = bus::read_credentials(folder, "tracker", now);
    return read ? "" : read.error();
  }
  static void copy(const fs::path& from, const fs::path& to) {
    fs::copy_file(from, to, fs::copy_options::overwrite_existing);
  }

  test::TemporaryFolder place_;
};

TEST_F(SecureFolder, HasAcceptedCredentialsForEveryRole) {
  const fs::path folder = make("secured");
  for (const Role& role : roles({})) {
    const auto credentials = bus::read_credentials(folder, role.name);
    ASSERT_TRUE(credentials) << credentials.error();
    EXPECT_EQ(credentials->identity, role.name);
    EXPECT_EQ(mode_of(credentials->key), 0600U) << role.name;
    EXPECT_EQ(mode_of(folder / role.name), 0700U) << role.name;
  }
  EXPECT_EQ(mode_of(folder), 0700U);
}

TEST_F(SecureFolder, IsUsableInParts) {
  const fs::path folder = make("secured");
  const fs::path machine = place_ / "machine";
  fs::create_directory(machine);
  for (const char* file : {bus::kCaFile, bus::kGovernanceFile}) copy(folder / file, machine / file);
  fs::copy(folder / "tracker", machine / "tracker");
  EXPECT_EQ(refusal(machine), "");
}

TEST_F(SecureFolder, IsReplacedOnlyWhenForced) {
  const fs::path folder = make("secured");
  const std::string before = test::read_text(folder / bus::kCaFile);
  const Validity validity = ten_years(Clock::now());
  const auto refused = make_secure_folder(folder, {.validity = validity});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error(), HasSubstr("secured: exists"));
  EXPECT_EQ(test::read_text(folder / bus::kCaFile), before);
  EXPECT_TRUE(make_secure_folder(folder, {.validity = validity, .force = true}));
  EXPECT_NE(test::read_text(folder / bus::kCaFile), before);
  EXPECT_EQ(refusal(folder), "");
  EXPECT_EQ(std::distance(fs::directory_iterator(place_.path()), {}), 1) << "nothing is left beside it";
}

TEST_F(SecureFolder, IsNeverPutInPlaceOfAnotherFolder) {
  test::write_text(place_ / "home/letter.txt", "precious");
  const auto refused =
      make_secure_folder(place_ / "home", {.validity = ten_years(Clock::now()), .force = true});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error(), HasSubstr("left alone"));
  EXPECT_EQ(test::read_text(place_ / "home/letter.txt"), "precious");
}

TEST_F(SecureFolder, WithoutAPlaceForItSaysSo) {
  const auto refused = make_secure_folder(place_ / "no/such/parent", {.validity = ten_years(Clock::now())});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error(), HasSubstr("cannot be written"));
}

TEST_F(SecureFolder, HoldsForTenYears) {
  const Clock::time_point now = Clock::now();
  const fs::path folder = make("secured", now);
  EXPECT_EQ(refusal(folder, now - std::chrono::hours(23)), "");
  EXPECT_EQ(refusal(folder, now + std::chrono::days(3650)), "");
  EXPECT_THAT(refusal(folder, now - std::chrono::hours(25)), HasSubstr("clock is before that"));
  EXPECT_THAT(refusal(folder, now + std::chrono::days(3654)), HasSubstr("ca.pem: has expired on"));
}

TEST_F(SecureFolder, MissingPartsAreNamed) {
  EXPECT_THAT(refusal(place_ / "nowhere"), HasSubstr("nowhere: no such folder"));
  const fs::path folder = make("secured");
  for (const char* file : {"ca.pem", "governance.p7s", "tracker/cert.pem", "tracker/key.pem",
                           "tracker/permissions.p7s"}) {
    fs::rename(folder / file, place_ / "aside");
    EXPECT_THAT(refusal(folder), HasSubstr(std::string(file) + ": cannot be read"));
    fs::rename(place_ / "aside", folder / file);
  }
  fs::remove_all(folder / "tracker");
  EXPECT_THAT(refusal(folder), HasSubstr("tracker: no such folder"));
}

TEST_F(SecureFolder, TornPartsAreNamed) {
  const fs::path folder = make("secured");
  for (const char* file : {"ca.pem", "governance.p7s", "tracker/cert.pem", "tracker/key.pem",
                           "tracker/permissions.p7s"}) {
    const std::string whole = test::read_text(folder / file);
    for (const std::size_t size : {std::size_t{0}, whole.size() / 4, whole.size() / 2}) {
      test::write_text(folder / file, whole.substr(0, size));
      EXPECT_THAT(refusal(folder), HasSubstr(std::string(file) + ": is damaged")) << size;
    }
    test::write_text(folder / file, whole);
  }
  EXPECT_EQ(refusal(folder), "");
}

TEST_F(SecureFolder, ChangedDocumentsAreRefused) {
  const fs::path folder = make("secured");
  for (const char* file : {"governance.p7s", "tracker/permissions.p7s"}) {
    const std::string text = test::read_text(folder / file);
    std::string changed = text;
    changed.replace(changed.find("ENCRYPT") == std::string::npos ? changed.find("DENY") : changed.find("ENCRYPT"),
                    4, "NONE");
    test::write_text(folder / file, changed);
    EXPECT_THAT(refusal(folder), HasSubstr(std::string(file) + ": is damaged or was signed by another"));
    test::write_text(folder / file, text);
  }
}

TEST_F(SecureFolder, PartsOfAnotherAuthorityAreRefused) {
  const fs::path folder = make("secured");
  const fs::path foreign = make("foreign");
  for (const char* file : {"governance.p7s", "tracker/permissions.p7s", "tracker/cert.pem"}) {
    const std::string own = test::read_text(folder / file);
    copy(foreign / file, folder / file);
    EXPECT_THAT(refusal(folder), HasSubstr(std::string(file) + ": ")) << file;
    EXPECT_THAT(refusal(folder), HasSubstr("signed by")) << file;
    test::write_text(folder / file, own);
  }
}

TEST_F(SecureFolder, PartsOfAnotherServiceAreRefused) {
  const fs::path folder = make("secured");
  const fs::path part = folder / "tracker";
  fs::copy(part, place_ / "aside");
  copy(folder / "mapper/permissions.p7s", part / "permissions.p7s");
  EXPECT_THAT(refusal(folder), HasSubstr("permissions.p7s: are of 'CN=mapper,O=RDS-SLAM'"));
  copy(folder / "mapper/key.pem", part / "key.pem");
  EXPECT_THAT(refusal(folder), HasSubstr("key.pem: is not the key of cert.pem"));
  copy(folder / "mapper/cert.pem", part / "cert.pem");
  EXPECT_THAT(refusal(folder), HasSubstr("cert.pem: is of 'mapper', expected 'tracker'"));
}

/// True if the role may publish a topic of this name, itself or by a pattern with a '*' at its end.
bool publishes(const Role& role, const std::string& topic) {
  return std::ranges::any_of(role.publishes, [&](const std::string& pattern) {
    return pattern == topic || (pattern.ends_with('*') && topic.starts_with(pattern.substr(0, pattern.size() - 1)));
  });
}

TEST(Roles, OnlyTheOperatorCommandsAndAViewerThatIsAllowedTo) {
  for (const Role& role : roles({}))
    EXPECT_EQ(publishes(role, "rds/command"), role.name == "operator" || role.name == "viewer") << role.name;
}

TEST(Roles, NobodyButAServiceWritesWhatItMakes) {
  for (const Role& role : roles({})) {
    EXPECT_EQ(publishes(role, "rds/map/full"), role.name == "mapper") << role.name;
    EXPECT_EQ(publishes(role, "rds/odometry"), role.name == "tracker") << role.name;
    EXPECT_EQ(publishes(role, "rds/detections"), role.name == "detector") << role.name;
    EXPECT_EQ(publishes(role, "rds/boxes"), role.name == "transformer") << role.name;
    EXPECT_EQ(publishes(role, "rds/map/chunks/reader_1"), role.name == "mapper") << role.name;
  }
}

TEST(Roles, WhoReadsTheMapMayAskForIt) {
  for (const Role& role : roles({})) {
    const bool reads_it = role.name == "reader" || role.name == "operator" || role.name == "viewer";
    EXPECT_EQ(publishes(role, "rds/map/requests"), reads_it) << role.name;
  }
}

TEST(Roles, TakeTheCamerasTopicsAsTheyAreGiven) {
  for (const Role& role : roles({.camera = {"kinect/color", "kinect/depth"}})) {
    const bool shows = role.name == "operator" || role.name == "player" || role.name == "camera";
    EXPECT_EQ(publishes(role, "kinect/depth"), shows) << role.name;
    EXPECT_FALSE(publishes(role, "camera/color/image_raw")) << role.name;
  }
}

TEST(Roles, WhatARobotSensesIsWrittenByItsNodesAndByWhoPlaysRecordings) {
  for (const Role& role : roles({.sensors = {"wheels/odom", "imu/data"}})) {
    const bool plays = role.name == "player" || role.name == "operator";
    EXPECT_EQ(publishes(role, "imu/data"), plays || role.name == "robot") << role.name;
    EXPECT_FALSE(publishes(role, "imu")) << role.name;
    const bool reads = role.name == "tracker" || role.name == "operator";
    EXPECT_EQ(std::ranges::count(role.subscribes, "wheels/odom"), reads ? 1 : 0) << role.name;
    const bool mounts = plays || role.name == "robot" || role.name == "camera";
    EXPECT_EQ(publishes(role, "tf_static"), mounts) << role.name;
  }
}

}  // namespace
}  // namespace rds::secure
