// Help, man pages and completion, as a terminal, man's own checkers and the real shells see them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "tests/support/long.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Key;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class Help : public test::CommandLineTest {
 protected:
  bool has_plot() const { return run("vestige plot --help").exit_code == 0; }

  /// "vestige record", …, "vestige plot sweep", …: every command that does something.
  std::vector<std::string> commands() const {
    std::vector<std::string> commands;
    for (const std::string& line : lines_of(run("vestige complete ''").standard_output)) {
      const std::string verb = line.substr(0, line.find('\t'));
      if (verb != "plot") commands.push_back("vestige " + verb);
    }
    for (const std::string& line : lines_of(run("vestige complete plot ''").standard_output))
      commands.push_back("vestige plot " + line.substr(0, line.find('\t')));
    return commands;
  }
};

TEST_F(Help, OfEveryCommandFitsATerminalAndShowsItsDefaults) {
  const std::vector<std::string> all = commands();
  EXPECT_GE(all.size(), 8U);
  for (const std::string& command : all) {
    const test::Outcome help = run(command + " --help");
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_THAT(help.standard_output, AllOf(StartsWith("Examples:\n  vestige "), HasSubstr("\nUsage: " + command),
                                            HasSubstr("-h, --help"), HasSubstr("Print this help\n")));
    for (const std::string& line : lines_of(help.standard_output)) {
      // An example is one line, whatever its length: it is there to be copied.
      if (line.starts_with("  vestige ")) continue;
      EXPECT_LE(line.size(), 100U) << command << ": " << line;
    }
  }
  EXPECT_THAT(run("vestige replay --help").standard_output,
              AllOf(HasSubstr("--surface all|mapped"), HasSubstr("actuator,t,triangle]"), HasSubstr("default: 60")));
}

/// Each verb has two examples, and both run as they stand, on files of the names that they use. Long tests run the
/// second one, others the first.
TEST_F(Help, ExamplesRunAsTheyStand) {
  const auto avatar = builtin_avatar_glb();
  const auto map = builtin_actuator_map_png();
  ASSERT_EQ(
      run("vestige record --rate 100 --duration 1.6 -o man.mcap && "
          "vestige trim man.mcap --to 1 -o beginning.mcap && vestige trim man.mcap --from 1 -o end.mcap && "
          "cp beginning.mcap part-1.mcap && cp end.mcap part-2.mcap && "
          "vestige replay man.mcap --timeline timeline.csv --textures textures.exr --contacts contacts.csv && "
          "vestige batch --maps builtin --traces man.mcap --laws binary -o compared -q && "
          "mkdir -p results/sweep gpu software figures && "
          "vestige accuracy --detector cpu --colliders swarm --rate 60 --truth-rate 240 --duration 0.1 --count 5 "
          "--no-figure -o results/accuracy -q && "
          "vestige stress --detector cpu --families vertex --n 1 --no-figure -o results/stress -q && "
          "vestige growth --detector cpu --counts 1,2 --count 2 --subdivisions 0 --min-time 0.01 --runs 1 --run-frames "
          "2 "
          "--no-figure -o results/growth -q && rm results/growth/trace.mcap && "
          "printf '1,4,1,4,1,1,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,1,1,0,1,1\n"
          "1,4,1,4,-1,1,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,1,1,0,1,1\n' >queries.csv && "
          "vestige sweep man.mcap --counts 1,10 --detector cpu --min-time 0.01 --runs 1 --run-frames 5 "
          "--stages --no-figure -o results/sweep -q && cp -r results/sweep before && cp -r results/sweep after && cp "
          "results/sweep/sweep.json gpu && cp results/sweep/sweep.json software "
          "&& vestige claims results -o results/README.md && vestige export man.mcap -o man_csv && "
          "vestige export man.mcap -o man.ndjson && "
          "vestige live --from - --port file:felt --json live.json -q <man.ndjson && "
          "printf 'HIERARCHY\nROOT hips\n{\nOFFSET 0 95 0\nCHANNELS 1 Yrotation\n"
          "JOINT leftUpperLeg\n{\nOFFSET 10 0 0\nCHANNELS 0\nJOINT leftFoot\n{\nOFFSET 0 -90 0\nCHANNELS 0\n}\n}\n}\n"
          "MOTION\nFrames: 2\nFrame Time: 0.1\n0\n10\n' >walk.bvh && mkdir given && mv [!g]* gpu given")
          .exit_code,
      0);
  for (const std::string& command : commands()) {
    std::vector<std::string> examples;
    for (const std::string& line : lines_of(run(command + " --help").standard_output))
      if (line.starts_with("  " + command)) examples.push_back(line.substr(2));
    EXPECT_EQ(examples.size(), 2U) << command;
    if (examples.size() == 2) examples.erase(examples.begin() + (test::is_long() ? 0 : 1));
    for (const std::string& example : examples) {
      if (example.find("/dev/tty") != std::string::npos) continue;  // no vest is here
      ASSERT_EQ(run("mkdir here && cp -r given/. here").exit_code, 0);
      write("here/man.glb", avatar);
      write("here/regions.png", map);
      // What the example writes must not be there yet; and a long measurement is only begun.
      if (command == "vestige record" || command == "vestige merge") run("rm here/man.mcap");
      if (command == "vestige trim") run("rm here/beginning.mcap");
      if (command == "vestige batch") run("rm -r here/compared");
      if (command == "vestige replay") run("rm here/*.csv here/*.exr");
      const std::map<std::string, std::pair<const char*, const char*>> long_ones = {
          {"vestige sweep", {"sweep.json", "\"colliders\": "}},
          {"vestige growth", {"growth.json", "\"colliders\": "}},
          {"vestige accuracy", {"accuracy.json", "\"colliders\": "}},
          {"vestige stress", {"stress.json", "\"families\": "}}};
      const bool is_long = long_ones.contains(command);
      const test::Outcome outcome =
          run("cd here && { " + std::string(is_long ? "timeout --foreground -s INT 1 " : "") + example + "\n}");
      if (is_long) {
        EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(0, 124)) << example << "\n" << outcome.standard_error;
        // What there was time for is written; on a slow machine that is nothing, which is said.
        const auto& [name, field] = long_ones.at(command);
        const auto written = folder_ / "here" / example.substr(example.rfind(' ') + 1) / name;
        if (std::filesystem::exists(written))
          EXPECT_THAT(read_text_file(written), HasSubstr(field)) << example;
        else
          EXPECT_THAT(outcome.standard_error, HasSubstr("before anything had been measured")) << example;
      } else {
        EXPECT_EQ(outcome.exit_code, 0) << example << "\n" << outcome.standard_error;
      }
      ASSERT_EQ(run("rm -rf here").exit_code, 0);
    }
  }
}

TEST_F(Help, ManPagesHaveNoWarnings) {
  ASSERT_EQ(run("vestige man --pages man1").exit_code, 0);
  if (has_plot()) {
    ASSERT_EQ(run("vestige man plot > man1/vestige-plot.1").exit_code, 0);
  }
  EXPECT_TRUE(std::filesystem::exists(folder_ / "man1/vestige.1"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "man1/vestige-replay.1"));
  EXPECT_EQ(run("vestige man replay").standard_output, read_text_file(folder_ / "man1/vestige-replay.1"));
  if (run("command -v mandoc groff").exit_code != 0)
    GTEST_SKIP() << "mandoc OR groff IS NOT INSTALLED: THE MAN PAGES WERE NOT CHECKED";
  EXPECT_EQ(run("mandoc -Tlint -Wwarning man1/*").standard_output, "");
  EXPECT_EQ(run("for page in man1/*; do groff -ww -man -Tutf8 $page >/dev/null; done").standard_error, "");
  const std::string page = run("mandoc -Tascii -Owidth=100 man1/vestige-record.1 | col -b").standard_output;
  EXPECT_THAT(page, AllOf(HasSubstr("--rate HZ"), HasSubstr("default: 1000"), HasSubstr("EXIT STATUS"),
                          HasSubstr("vestige record -o man.mcap")));
}

TEST_F(Help, ManPagesAreNotOverwrittenWithoutForce) {
  ASSERT_EQ(run("mkdir man1 && echo mine > man1/vestige.1").exit_code, 0);
  EXPECT_EQ(run("vestige man --pages man1").exit_code, 1);
  EXPECT_EQ(read_text_file(folder_ / "man1/vestige.1"), "mine\n");
  EXPECT_EQ(run("vestige man --pages man1 --force").exit_code, 0);
  EXPECT_EQ(run("vestige man frobnicate").exit_code, 2);
}

TEST_F(Help, TheReferenceInDocsIsWhatTheProgramWrites) {
  constexpr const char* kRemedy =
      "\nTo write the reference anew: cmake --build BUILD -t reference. A page that no verb has is to be removed.";
  ASSERT_EQ(run("vestige man --markdown written && vestige explain > written/files.md").exit_code, 0);
  const bool with_plot = has_plot();
  if (with_plot) {
    ASSERT_EQ(run("vestige-plot man --markdown > written/plot.md").exit_code, 0);
  }
  const auto pages_in = [&](const std::filesystem::path& folder) {
    std::map<std::string, std::string> pages;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (with_plot || entry.path().filename() != "plot.md")
        pages[entry.path().filename()] = read_text_file(entry.path());
    return pages;
  };
  const auto committed = pages_in(std::filesystem::path(VESTIGE_SOURCE_DIR) / "docs/reference");
  const auto written = pages_in(folder_ / "written");
  EXPECT_THAT(written, AllOf(Contains(Key("README.md")), Contains(Key("record.md")), Contains(Key("man.md"))));
  for (const auto& [name, page] : written) {
    ASSERT_TRUE(committed.contains(name)) << "docs/reference/" << name << " is missing." << kRemedy;
    EXPECT_EQ(committed.at(name), page) << "docs/reference/" << name << " is not what the program writes." << kRemedy;
  }
  for (const auto& [name, page] : committed)
    EXPECT_TRUE(written.contains(name)) << "docs/reference/" << name << " is not written by the program." << kRemedy;
}

TEST_F(Help, MarkdownPagesAreNotOverwrittenWithoutForce) {
  ASSERT_EQ(run("mkdir pages && echo mine > pages/README.md").exit_code, 0);
  EXPECT_EQ(run("vestige man --markdown pages").exit_code, 1);
  EXPECT_EQ(read_text_file(folder_ / "pages/README.md"), "mine\n");
  EXPECT_EQ(run("vestige man --markdown pages --force").exit_code, 0);
  EXPECT_THAT(read_text_file(folder_ / "pages/README.md"), HasSubstr("(record.md)"));
  EXPECT_EQ(run("vestige man --markdown pages --pages man1").exit_code, 2);
  EXPECT_EQ(run("vestige man --force").exit_code, 2);
}

class Completion : public Help {
 protected:
  /// What bash offers for a line; its last word is the one being typed.
  std::vector<std::string> bash(const std::string& words) const {
    const test::Outcome outcome =
        run("cat > ask.bash <<'END'\nsource <(vestige completion bash)\nCOMP_WORDS=(" + words +
            ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n$(complete -p vestige | sed 's/.*-F \\([^ ]*\\).*/\\1/')\n"
            "printf '%s\\n' \"${COMPREPLY[@]}\"\nEND\nbash --norc ask.bash");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    return lines_of(outcome.standard_output);
  }
};

TEST_F(Completion, InBashOffersVerbsFlagsValuesAndFiles) {
  ASSERT_EQ(run("touch 'a man.mcap' man.csv && mkdir mans").exit_code, 0);
  EXPECT_THAT(bash("vestige ''"), IsSupersetOf({"record", "replay", "sweep", "inspect", "devices", "plot", "claims"}));
  EXPECT_THAT(bash("vestige ''"), Not(Contains("complete")));
  EXPECT_THAT(bash("vestige re"), UnorderedElementsAre("record", "recompress", "recover", "replay"));
  EXPECT_THAT(bash("vestige --"), UnorderedElementsAre("--help", "--version"));
  EXPECT_THAT(bash("vestige replay --de"), UnorderedElementsAre("--detector", "--device"));
  EXPECT_THAT(bash("vestige replay --detector ''"), IsSupersetOf({"auto", "paper", "cpu"}));
  EXPECT_THAT(bash("vestige replay --detector cp"), UnorderedElementsAre("cpu"));
  EXPECT_THAT(bash("vestige replay --detector cpu --det"), UnorderedElementsAre("")) << "offered twice";
  EXPECT_THAT(bash("vestige replay a"), UnorderedElementsAre("a man.mcap", "ask.bash"));
  EXPECT_THAT(bash("vestige record --map "), Contains("--map"));
  EXPECT_THAT(bash("vestige record --map m"), UnorderedElementsAre("man.csv", "mans"));
  EXPECT_THAT(bash("vestige record --avatar b"), UnorderedElementsAre("builtin"));
  EXPECT_THAT(bash("vestige record --count ''"), UnorderedElementsAre(""));
  EXPECT_THAT(bash("vestige completion ''"), UnorderedElementsAre("bash", "zsh", "fish"));
  if (!has_plot()) GTEST_SKIP() << "BUILT WITHOUT VTK: vestige plot WAS NOT COMPLETED";
  EXPECT_THAT(bash("vestige plot ''"), IsSupersetOf({"sweep", "timeline", "textures"}));
  EXPECT_THAT(bash("vestige plot sweep --f"), UnorderedElementsAre("--force"));
  EXPECT_THAT(bash("vestige plot scene 'a m'"), UnorderedElementsAre("a man.mcap"));
}

TEST_F(Completion, InFishOffersVerbsWithTheirMeaningsFlagsAndFiles) {
  if (run("command -v fish").exit_code != 0) GTEST_SKIP() << "fish IS NOT INSTALLED: ITS COMPLETION WAS NOT TESTED";
  ASSERT_EQ(run("touch man.mcap").exit_code, 0);
  const auto fish = [&](const std::string& line) {
    return run("HOME=$PWD fish --no-config -c 'vestige completion fish | source; complete -C \"" + line + "\"'")
        .standard_output;
  };
  EXPECT_EQ(fish("vestige rep"), "replay\tRun a trace through a collision detector\n");
  EXPECT_THAT(fish("vestige replay --det"), StartsWith("--detector\t"));
  EXPECT_THAT(fish("vestige replay --detector p"), StartsWith("paper"));
  EXPECT_THAT(fish("vestige replay man"), HasSubstr("man.mcap"));
  EXPECT_EQ(fish("vestige record --count "), "");
}

TEST_F(Completion, InZshOffersVerbsFlagsAndFiles) {
  if (run("command -v zsh").exit_code != 0) GTEST_SKIP() << "zsh IS NOT INSTALLED: ITS COMPLETION WAS NOT TESTED";
  ASSERT_EQ(run("touch man.mcap && mkdir site && vestige completion zsh > site/_vestige").exit_code, 0);
  EXPECT_EQ(run("zsh -n site/_vestige").standard_error, "");
  // A zsh in a terminal of its own, to which Tab is typed.
  std::ofstream(folder_ / "ask.zsh") << R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'PS1=; fpath=($PWD/site $fpath); autoload -Uz compinit; compinit -u -D; LISTMAX=1000; stty cols 200; zstyle ":completion:*" list-prompt ""'
# Reads on until all of the words are there, or a minute has passed.
await() {
  local text= part word round missing
  for round in {1..1200}; do
    while zpty -r -t shell part; do text+=$part; done
    missing=
    for word; do [[ $text == *$word* ]] || missing=1; done
    [[ -z $missing ]] && break
    sleep 0.05
  done
  print -r -- "$text"
}
zpty -w shell 'print re''ady'
await ready >/dev/null
zpty -w -n shell "$1"$'\t'$'\t'
await "${(@)argv[2,-1]}"
zpty -d shell
)";
  const auto expect = [&](const std::string& line, const std::vector<std::string>& words) {
    std::string command = "HOME=$PWD zsh -f ask.zsh '" + line + "'";
    for (const std::string& word : words) command += " '" + word + "'";
    const std::string shown = run(command).standard_output;
    for (const std::string& word : words) EXPECT_THAT(shown, HasSubstr(word)) << line;
  };
  expect("vestige re", {"record", "Run a trace through a collision detector"});
  expect("vestige replay --de", {"--detector", "--device"});
  expect("vestige replay --detector pa", {"paper"});
  expect("vestige replay ma", {"man.mcap"});
}

}  // namespace
}  // namespace vestige
