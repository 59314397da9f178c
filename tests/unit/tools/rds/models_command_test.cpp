// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/models_command.hpp"

#include <cstdlib>
#include <sstream>

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"
#include "tools/rds/cli/commands.hpp"
#include "tools/rds/network_script.hpp"

namespace rds::tools {
namespace {

namespace fs = std::filesystem;
using detector::DetectorError;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Scripts and cache in a folder of the test's own.
class ModelsCommand : public ::testing::Test {
 protected:
  ModelsCommand() {
    setenv("RDS_NETWORK_SCRIPTS", folder_.path().c_str(), 1);
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
  }
  ~ModelsCommand() override {
    unsetenv("RDS_NETWORK_SCRIPTS");
    unsetenv("XDG_CACHE_HOME");
  }
  void write_script(const std::string& name, const std::string& body) const {
    test::write_text(folder_ / name, "#!/bin/sh\n" + body + "\n");
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }
  [[nodiscard]] static std::string error_of(const std::function<void()>& action) {
    try {
      action();
      return "none";
    } catch (const DetectorError& e) {
      return e.what();
    }
  }

  test::TemporaryFolder folder_;
  std::ostringstream out_;
};

TEST_F(ModelsCommand, ListNamesEveryNetworkItsLicenceAndTheDefault) {
  list_models(out_, {folder_.path()});
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("* nanodet_g"), HasSubstr("  yolox_nano"), HasSubstr("Apache-2.0"),
                                HasSubstr("missing (`rds models fetch nanodet_g`)")));
}

TEST_F(ModelsCommand, ListShowsWhereAFileWasFound) {
  test::write_text(folder_ / "mobilenetv2_ssdlite_voc.onnx", "x");
  list_models(out_, {folder_.path()});
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("* mobilenetv2_ssdlite_voc"),
                                HasSubstr((folder_ / "mobilenetv2_ssdlite_voc.onnx").string())));
}

TEST_F(ModelsCommand, FetchGivesTheCacheToTheNetworksScript) {
  write_script("fetch_nanodet_g.sh", "echo \"$1\" > \"$(dirname \"$0\")/argument\"; exit 3");
  EXPECT_THAT(error_of([&] { fetch_models(out_, {}); }), HasSubstr("fetch_nanodet_g.sh: failed"));
  EXPECT_EQ(test::read_text(folder_ / "argument"),
            (folder_ / "cache" / "rds-slam" / "models").string() + "\n");
}

TEST_F(ModelsCommand, FetchDoesNotTrustTheScript) {
  write_script("fetch_nanodet_g.sh", "mkdir -p \"$1\"; echo wrong > \"$1/nanodet_g_416x320.onnx\"");
  EXPECT_THAT(error_of([&] { fetch_models(out_, {"nanodet_g"}); }), HasSubstr("expected SHA-256"));
}

TEST_F(ModelsCommand, FetchNamesTheSourceOfWhatItCannotBring) {
  EXPECT_THAT(error_of([&] { fetch_models(out_, {"yolox_nano"}); }),
              HasSubstr("cannot be fetched; its source is"));
}

TEST_F(ModelsCommand, CheckReportsAnAlteredFile) {
  test::write_text(folder_ / "yolox_nano.onnx", "altered");
  EXPECT_THAT(error_of([&] { check_models(out_, {}, {folder_.path()}); }), HasSubstr("expected SHA-256"));
  EXPECT_THAT(out_.str(), HasSubstr("yolox_nano: not usable"));
}

TEST_F(ModelsCommand, CheckSaysHowToGetANetworkWhereThereIsNone) {
  EXPECT_THAT(error_of([&] { check_models(out_, {}, {folder_.path()}); }), HasSubstr("rds models fetch"));
}

TEST_F(ModelsCommand, AMissingScriptIsNamed) {
  EXPECT_THAT(error_of([&] { run_network_script("fetch_nothing.sh", folder_.path()); }),
              HasSubstr("fetch_nothing.sh: not found"));
}

TEST_F(ModelsCommand, HangsBelowRds) {
  CLI::App rds;
  add_models_command(rds);
  EXPECT_NO_THROW(rds.parse("models --model-dir " + folder_.path().string() + " list"));
  EXPECT_THROW(rds.parse("models"), CLI::RequiredError);
}

}  // namespace
}  // namespace rds::tools
