// Where `kadans run` writes its lines: stderr, systemd's journal, a file.
#include <cstdlib>

#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

TEST_CASE("run --log-file appends all lines, transitions and faults too, though stderr shows errors alone") {
  const auto project = project_copy("log_file");
  const std::string squat =
      "run config/tulip/robot.json --play squat --threads-on-virtual-time --duration 2 --log-file lines.txt";
  const Outcome first = run(squat, project);
  CHECK_MESSAGE(first.exit_code == 0, first.err);
  CHECK_FALSE(has(first.err, "squat: "));
  CHECK(has(first.err, " s  fault "));
  const std::string lines = read(project / "lines.txt");
  CHECK(has(lines, " s  squat: settle -> squat (after)\n"));
  CHECK(has(lines, "     2.00 s  supervisor: stop\n"));
  CHECK(has(lines, " s  fault "));
  (void)run(squat, project);
  CHECK(read(project / "lines.txt").starts_with(lines + "     1."));

  const Outcome nowhere = run(squat + "/none", project);
  CHECK(nowhere.exit_code == 2);
  CHECK(has(nowhere.err, "error: Failed opening file lines.txt/none for writing"));
}

TEST_CASE("run --log-file says once that the file cannot be written, goes on, and fails at its end") {
  const auto project = project_copy("full_log");
  const Outcome full = run(
      "run config/tulip/robot.json --play squat --threads-on-virtual-time --duration 2 --log-file /dev/full", project);
  CHECK(full.exit_code == 1);
  const std::string told = "error: /dev/full: not all lines of this run could be written: No space left on device\n";
  const std::size_t at = full.err.find(told);
  CHECK_MESSAGE(at != std::string::npos, full.err);
  CHECK(full.err.find("/dev/full", at + told.size()) == std::string::npos);
  CHECK_FALSE(has(full.err, "LOG ERROR"));
  CHECK_MESSAGE(has(full.out, "duration over"), full.out);
}

TEST_CASE("Lines on systemd's journal begin with their priority, all others do not") {
  const auto folder = fresh_folder("journal");
  const std::string program = std::string(KADANS_BINARY_DIR) + "/kadans";
  write(folder / "say.sh",
        "touch err; JOURNAL_STREAM=$(stat -c %d:%i err) $1 check none.json 2>err\n"
        "JOURNAL_STREAM=1:1 $1 check none.json 2>other; true\n");
  REQUIRE(std::system(("cd '" + folder.string() + "' && sh say.sh '" + program + "'").c_str()) == 0);
  CHECK(read(folder / "err").starts_with("<3>error: "));
  CHECK(read(folder / "other").starts_with("error: "));
}
