// What a build makes of the program's own tables: man pages, completion, and the manual's pages of reference.
#include <filesystem>
#include <sstream>
#include <string>

#include <doctest/doctest.h>

#include "app/program.h"
#include "command_line.h"

namespace man_page_test {

namespace fs = std::filesystem;
using namespace kadans;
using namespace kadans::program;

namespace {

// `kadans reference` in the project itself; once for all tests.
const fs::path& reference() {
  static const fs::path folder = [] {
    const fs::path made = fresh_folder("reference");
    const Outcome outcome = run("reference " + made.string(), project_copy("reference_project"));
    REQUIRE_MESSAGE(outcome.exit_code == 0, outcome.err);
    return made;
  }();
  return folder;
}

}  // namespace

TEST_CASE("every command has a man page, with all that its --help says") {
  const CommandLine line;
  CHECK(fs::exists(reference() / "man/kadans.1"));
  for (const CommandEntry& entry : commands_of(line)) {
    CAPTURE(entry.words);
    const std::string page =
        read(reference() / "man" / ("kadans-" + entry.words.substr(0, entry.words.find(' ')) + ".1"));
    CHECK(page.find(".SH NAME\nkadans\\-") != std::string::npos);
    for (const CLI::Option* option : entry.options) {
      for (const std::string& name : option->get_lnames()) {
        std::string written = "\\-\\-" + name;
        for (std::size_t at = 4; (at = written.find('-', at)) != std::string::npos; at += 2) written.insert(at, "\\");
        CHECK_MESSAGE(has(page, written), written);
      }
    }
  }
}

TEST_CASE("man pages hold no line that roff would take for a command of its own") {
  for (const auto& file : fs::directory_iterator(reference() / "man")) {
    std::istringstream lines(read(file.path()));
    for (std::string one; std::getline(lines, one);) {
      if (one.starts_with("'")) FAIL_CHECK(file.path().filename().string(), ": ", one);
      if (!one.starts_with(".")) continue;
      bool known = false;
      for (const char* macro : {".\\\"", ".TH ", ".SH ", ".SS ", ".TP", ".PP", ".nf", ".fi"})
        known |= one.starts_with(macro);
      if (!known) FAIL_CHECK(file.path().filename().string(), ": ", one);
    }
  }
}

TEST_CASE("the reference has each command, each file's fields and each control object's parameters") {
  const CommandLine line;
  const std::string commands = read(reference() / "pages/commands.md");
  for (const CommandEntry& entry : commands_of(line))
    CHECK_MESSAGE(has(commands, "\n## kadans " + entry.words + "\n"), entry.words);
  const std::string files = read(reference() / "pages/files.md");
  CHECK(has(files, "| `engine.control_period_s` | number"));
  const std::string objects = read(reference() / "pages/control_objects.md");
  CHECK(has(objects, "\n## joint_pid\n"));
  CHECK(has(objects, "| `kp_Nm_per_rad` |"));
}

TEST_CASE("hidden commands are in no completion") {
  CHECK(has(read(reference() / "completion/kadans"), "ctl"));
  CHECK_FALSE(has(read(reference() / "completion/kadans"), "behavior-process"));
}

}  // namespace man_page_test
