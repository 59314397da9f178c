// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <gmock/gmock.h>

#include "common/command_line/completion.hpp"
#include "common/command_line/document_option.hpp"
#include "common/command_line/manual.hpp"

namespace rds::command_line {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    auto* show = app_.add_subcommand("show", "Shows a thing: it's [here]");
    show->add_option("--form", form_, "How")->check(CLI::IsMember({"long", "short"}))->default_str("long");
    show->add_option("--file,file", file_, "What to show")->required()->envname("THING_FILE");
    show->add_flag("-q,--quiet", quiet_, "Say less");
    show->add_option("--secret", "Not for you")->group("");
    app_.add_subcommand("old", "Gone")->group("");
    add_document_option(app_, "1.2");
  }
  const OptionDescription& option(std::size_t index) {
    return description_.subcommands.at(0).options.at(index);
  }

  std::string form_;
  std::string file_;
  bool quiet_ = false;
  CLI::App app_{"does .things\\ well", "thing"};
  CommandDescription description_ = {};
};

TEST_F(CommandLine, DescribesWhatHelpShowsAndNothingElse) {
  description_ = describe(app_);
  ASSERT_EQ(description_.subcommands.size(), 1U);
  EXPECT_EQ(description_.subcommands[0].options.size(), 4U);  // with --help
  EXPECT_THAT(option(0).names, ElementsAre("-h", "--help"));
  EXPECT_FALSE(option(0).takes_value());
  EXPECT_THAT(option(1).choices, ElementsAre("long", "short"));
  EXPECT_EQ(option(1).default_value, "long");
  EXPECT_EQ(option(1).value, "TEXT");
  EXPECT_THAT(option(2).names, ElementsAre("--file"));
  EXPECT_EQ(option(2).place, "file");
  EXPECT_EQ(option(2).environment, "THING_FILE");
  EXPECT_TRUE(option(2).required);
  EXPECT_THAT(option(2).choices, IsEmpty());
  EXPECT_FALSE(option(3).takes_value());
}

TEST_F(CommandLine, WritesAManualPage) {
  const std::string page = manual_page(describe(app_), "1.2");
  EXPECT_THAT(page, HasSubstr(".TH THING 1 \"\" \"RDS\\-SLAM 1.2\""));
  EXPECT_THAT(page, HasSubstr("thing \\- does .things\\e well\n"));
  EXPECT_THAT(page, HasSubstr(".SS \"thing show\"\n\\fBthing show\\fR [\\fIoptions\\fR] \\fIfile\\fR\n"));
  EXPECT_THAT(page,
              HasSubstr(".TP\n\\fB\\-\\-form\\fR \\fITEXT\\fR\nHow. One of: long, short. Default: long\n"));
  EXPECT_THAT(page, HasSubstr("What to show. Environment: THING_FILE. Required\n"));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
}

TEST_F(CommandLine, CompletesOptionsAndTheirChoicesInBash) {
  const std::string script = bash_completion(describe(app_));
  EXPECT_THAT(script, HasSubstr("\"thing\") words=\"show -h --help\""));
  EXPECT_THAT(script, HasSubstr("\"thing show\") words=\"-h --help --form --file -q --quiet\""));
  EXPECT_THAT(script,
              HasSubstr("\"thing show:--form\")\n      mapfile -t COMPREPLY < <(compgen -W \"long short\""));
  EXPECT_THAT(script, HasSubstr("\"thing show:--file\")\n      mapfile -t COMPREPLY < <(compgen -f"));
}

TEST_F(CommandLine, CompletesOptionsAndTheirChoicesInZsh) {
  const std::string script = zsh_completion(describe(app_));
  EXPECT_THAT(script, testing::StartsWith("#compdef thing\n"));
  EXPECT_THAT(script, HasSubstr("'--form[How]:TEXT:(long short)'"));
  EXPECT_THAT(script, HasSubstr("'show:Shows a thing\\: it'\\''s \\[here\\]'"));
  EXPECT_THAT(script, HasSubstr("show) _thing_show ;;"));
}

TEST_F(CommandLine, TheHiddenOptionEndsTheProgramWithItsDocument) {
  app_.require_subcommand(1);
  try {
    app_.parse("--document man");
    FAIL() << "nothing was written";
  } catch (const CLI::CallForVersion& page) {
    EXPECT_EQ(page.get_exit_code(), 0);
    EXPECT_EQ(page.what(), manual_page(describe(app_), "1.2"));
  }
  EXPECT_THROW(app_.parse("--document html"), CLI::ValidationError);
  EXPECT_THAT(app_.help(), Not(HasSubstr("--document")));
}

}  // namespace
}  // namespace rds::command_line
