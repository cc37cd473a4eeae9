// The texts made of a command's tables, on a program that has every kind of flag.

#include "cli/help/command_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/help/completion.hpp"
#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"
#include "cli/help/markdown.hpp"

namespace vestige::help {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Tables : public ::testing::Test {
 protected:
  Tables() {
    program_.formatter(std::make_shared<HelpFormatter>("  prog draw -o x\n"));
    CLI::App* draw = program_.add_subcommand("draw", "Draw a thing");
    draw->formatter(std::make_shared<HelpFormatter>("  prog draw -o x\n  prog draw 'it''s' -o \\x\n"));
    draw->group("Verbs");
    draw->add_option("--kind", kind_, "What to draw:\n  dot    small and round\n  line   long\nor a file")
        ->capture_default_str()
        ->type_name("KIND|FILE");
    draw->add_option("--count", count_, "How many")->capture_default_str()->check(CLI::Range(1, 9));
    draw->add_option("-o,--output", output_, ".hidden things first")->required()->type_name("OUT");
    draw->add_flag("--secret", secret_, "Not told")->group("");
    program_.add_subcommand("ghost", "Not told")->group("");
  }

  std::string kind_ = "dot";
  std::string output_;
  int count_ = 3;
  bool secret_ = false;
  CLI::App program_{"A program", "prog"};
};

TEST_F(Tables, HelpShowsValuesOneALineWithRangesAndDefaults) {
  const std::string help = program_.get_subcommand("draw")->help();
  EXPECT_THAT(help, HasSubstr("What to draw:\n" + std::string(28, ' ') + "  dot    small and round\n"));
  EXPECT_THAT(help, HasSubstr("How many [1 to 9; default: 3]"));
  EXPECT_THAT(help, HasSubstr("Usage: prog draw [OPTIONS] -o OUT\n"));
  EXPECT_THAT(help, Not(HasSubstr("secret")));
  EXPECT_THAT(program_.help(), Not(HasSubstr("ghost")));
}

TEST_F(Tables, CompletionOffersExplainedValuesWithTheirMeaning) {
  const CommandTable table = command_table(program_);
  EXPECT_EQ(completions(table, {"draw", "--kind", ""}), "dot\tsmall and round\nline\tlong\n:\n");
  EXPECT_EQ(completions(table, {"draw", "--ki"}), "--kind\tWhat to draw:\n");
  EXPECT_EQ(completions(table, {"gh"}), "");
  EXPECT_EQ(completions(table, {}), "draw\tDraw a thing\n");
}

TEST_F(Tables, ManPagesEscapeWhatRoffWouldObey) {
  const CommandTable draw = command_table(*program_.get_subcommand("draw"));
  const std::string page = manual_page(draw, VerbPages::kOwn, "1.2", "2026-01-02");
  EXPECT_THAT(page, HasSubstr("\n\\&.hidden things first"));
  EXPECT_THAT(page, HasSubstr("prog draw \\(aqit\\(aq\\(aqs\\(aq \\-o \\ex\n"));
  EXPECT_THAT(page, HasSubstr("What to draw:\n.br\ndot    small and round\n.br\nline   long\n.br\nor a file"));
}

TEST_F(Tables, MarkdownPagesEscapeWhatWouldBeMarkup) {
  program_.get_subcommand("draw")->add_option("--shape", kind_, "<a*b>, snake_case and _this_, `x|y`");
  const CommandTable draw = command_table(*program_.get_subcommand("draw"));
  const std::string page = markdown_page(draw);
  EXPECT_THAT(page, HasSubstr("\n  \\<a\\*b\\>, snake_case and \\_this\\_, \\`x\\|y\\`\n"));
  EXPECT_THAT(page, HasSubstr("\n# prog draw\n\nDraw a thing.\n\n```\nprog draw [OPTIONS] -o OUT\n```\n"));
  EXPECT_THAT(page, HasSubstr("\n```sh\nprog draw -o x\nprog draw 'it''s' -o \\x\n```\n"));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
}

TEST_F(Tables, MarkdownPagesListOptionsWithRangeDefaultAndValues) {
  const std::string page = markdown_page(command_table(*program_.get_subcommand("draw")));
  EXPECT_THAT(page, HasSubstr("\n- `--count N` (1 to 9; default: 3)\\\n  How many\n"));
  EXPECT_THAT(page, HasSubstr("\n- `--kind KIND|FILE` (default: dot)\\\n  What to draw:\n"
                              "  - `dot`: small and round\n  - `line`: long\n\n  or a file\n"));
}

TEST_F(Tables, TheMarkdownIndexLeadsToThePagesAndTellsWhatIsReadAndWritten) {
  CLI::App* undo = program_.get_subcommand("draw")->add_subcommand("undo", "Take a | back");
  undo->add_option("DIR", kind_, "Where")->required();
  undo->add_option("--port", output_, "Whereto")->type_name("DEVICE|udp://HOST:PORT|file:OUT|-");
  const std::string index = markdown_index(command_table(program_));
  EXPECT_THAT(index, HasSubstr("| [draw](draw.md) | Draw a thing |\n"));
  EXPECT_THAT(index, HasSubstr("| [draw](draw.md) | `--kind FILE` | `--output OUT` |\n"));
  EXPECT_THAT(index, HasSubstr("| [draw undo](draw.md#prog-draw-undo) | `DIR` | `--port file:OUT` |\n"));
  EXPECT_THAT(index, HasSubstr("| 2 | wrong usage |\n"));
  const std::string page = markdown_page(command_table(*program_.get_subcommand("draw")));
  EXPECT_THAT(page, HasSubstr("| [undo](#prog-draw-undo) | Take a \\| back |\n"));
  EXPECT_THAT(page, HasSubstr("\n## prog draw undo\n"));
}

}  // namespace
}  // namespace vestige::help
