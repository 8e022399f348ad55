// `kadans log` as a person uses it, on records of kadans sim.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

using namespace kadans::program;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

// Half a second of one scenario, as run.mcap; the same again as again.mcap, with another seed as other.mcap.
fs::path records(const std::string& name) {
  const fs::path folder = project_copy(name);
  for (const char* file : {"run", "again", "other"}) {
    const std::string seed = file == std::string("other") ? "9" : "4";
    const Outcome outcome = run(
        "sim config/scenarios/squat_varied.json --duration 0.5 --seed " + seed + " --record " + file + ".mcap", folder);
    REQUIRE_MESSAGE(fs::exists(folder / (file + std::string(".mcap"))), outcome.err);
  }
  return folder;
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// The program where there is no other.
struct EmptyPath {
  std::string path = std::getenv("PATH");             // NOLINT: no thread
  EmptyPath() { setenv("PATH", "/nonexistent", 1); }  // NOLINT: no thread
  ~EmptyPath() { setenv("PATH", path.c_str(), 1); }   // NOLINT: no thread
  EmptyPath(const EmptyPath&) = delete;
  EmptyPath& operator=(const EmptyPath&) = delete;
};

}  // namespace

TEST_CASE("log info says what run a record is of, what it holds, how to run it again, and whether it is whole") {
  const fs::path folder = records("log_info");
  const Outcome text = run("log info run.mcap", folder);
  CHECK(text.exit_code == 0);
  for (const char* part : {"config/scenarios/squat_varied.json, seed 4", "tulip", "kadans 0.2.0", "dropped: 0 rows",
                           "kadans sim config/scenarios/squat_varied.json --seed 4 --duration 0.5",
                           "0.000 s to 0.499 s", "ends well", "/joint", "kadans_msgs/msg/Joint", "rows         500"})
    CHECK_MESSAGE(has(text.out, part), part << "\n" << text.out);
  const Json whole = Json::parse(run("log info run.mcap --json", folder).out);
  CHECK(whole["complete"] == true);
  CHECK(whole["robot"] == "tulip");
  CHECK(whole["facts"]["run"]["seed"] == "4");
  CHECK(whole["topics"].size() > 5);
  CHECK(whole["unpacked_bytes"] > whole["file_bytes"]);

  write(folder / "short.mcap", read(folder / "run.mcap").substr(0, read(folder / "run.mcap").size() * 3 / 4));
  const Outcome cut = run("log info short.mcap", folder);
  CHECK(cut.exit_code == 0);
  CHECK(has(cut.out, "CUT SHORT"));
  CHECK(has(cut.out, "byte "));
  CHECK_FALSE(has(cut.out, "ends well"));
}

TEST_CASE("log cat and csv write rows that other tools read, end quietly when nobody reads on, and tell a cut record") {
  const fs::path folder = records("log_rows");
  const Outcome cat = run("log cat run.mcap --topic base --topic /support --from 0.1 --to 0.2", folder);
  CHECK(cat.exit_code == 0);
  CHECK(cat.err.empty());
  const Json first = Json::parse(cat.out.substr(0, cat.out.find('\n')));
  CHECK(first["time_s"].get<double>() >= 0.1);
  CHECK(first.contains("base.tilt_rad"));
  CHECK(has(cat.out, "\"topic\":\"/support\""));
  CHECK_FALSE(has(cat.out, "\"topic\":\"/joint\""));

  const Outcome csv = run("log csv run.mcap 'joint.*knee*' support.force_N --every 0.1", folder);
  CHECK(csv.exit_code == 0);
  CHECK(csv.out.substr(0, csv.out.find('\n')) ==
        "time_s,joint.l_knee.position_rad [rad],joint.l_knee.velocity_rad_s [rad/s],joint.l_knee.effort_Nm [Nm],"
        "joint.r_knee.position_rad [rad],joint.r_knee.velocity_rad_s [rad/s],joint.r_knee.effort_Nm [Nm],"
        "support.force_N [N]");
  CHECK(lines_in(csv.out) == 1 + 5);
  CHECK(run("log csv run.mcap -o table.csv", folder).out.empty());
  CHECK(lines_in(read(folder / "table.csv")) == 1 + 500);

  CHECK(run("log cat run.mcap 2>said | head -n 2 >two; cat said; wc -l <two", folder).out == "2\n");
  write(folder / "short.mcap", read(folder / "run.mcap").substr(0, read(folder / "run.mcap").size() * 3 / 4));
  const Outcome cut = run("log csv short.mcap base.tilt_rad", folder);
  CHECK(cut.exit_code == 0);
  CHECK(lines_in(cut.out) > 100);
  CHECK(has(cut.err, "cut short"));
}

TEST_CASE("log diff of a run and its repetition is the same, of another seed it says when and in what they part") {
  const fs::path folder = records("log_diff");
  const Outcome same = run("log diff run.mcap again.mcap", folder);
  CHECK_MESSAGE(same.exit_code == 0, same.out);
  CHECK(has(same.out, "the same; 500 rows"));
  const Outcome parted = run("log diff run.mcap other.mcap", folder);
  CHECK(parted.exit_code == 1);
  CHECK(has(parted.out, "they part at 0.0"));
  CHECK(has(parted.out, "made with another seed: 4, 9"));
  const Outcome json = run("log diff run.mcap other.mcap --json", folder);
  CHECK(json.exit_code == 1);
  CHECK(Json::parse(json.out)["same"] == false);
  CHECK(Json::parse(json.out)["partings"].size() > 10);
  CHECK(run("log diff run.mcap other.mcap --tolerance 1e9", folder).exit_code == 0);
}

TEST_CASE("a cut of a record is read by info, diff and replay") {
  const fs::path folder = records("log_cut");
  const Outcome made = run("log cut run.mcap --from 0.1 --to 0.3 -o cut.mcap", folder);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  const Outcome info = run("log info cut.mcap", folder);
  CHECK(has(info.out, "ends well"));
  CHECK(has(info.out, "part of      run.mcap"));
  CHECK(has(info.out, "to 0.300 s"));
  const Json diff = Json::parse(run("log diff run.mcap cut.mcap --json", folder).out);
  CHECK(diff["partings"].empty());
  CHECK(diff["signals_only_a"].empty());
  CHECK(diff["rows_only_b"] == 0);
  CHECK(diff["rows_only_a"].get<int>() > 200);
  const Outcome replay = run("replay cut.mcap --json", folder);
  CHECK_FALSE(Json::parse(replay.out).contains("parted"));

  CHECK(run("log cut run.mcap --signals 'base.*' --signals support -o few.mcap", folder).exit_code == 0);
  const Json few = Json::parse(run("log info few.mcap --json", folder).out);
  std::size_t signals = 0;
  for (const Json& topic : few["topics"]) signals += topic["signals"].get<std::size_t>();
  CHECK(signals == 12);
  CHECK(fs::file_size(folder / "few.mcap") < fs::file_size(folder / "run.mcap"));
}

TEST_CASE("log refuses what is wrong with the place, what was meant, and nothing written over") {
  const fs::path folder = records("log_wrong");
  write(folder / "text.mcap", "no record");
  write(folder / "there.csv", "precious");
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const Outcome outcome = run("log " + arguments, folder);
    CHECK_MESSAGE(outcome.exit_code == 2, arguments);
    CHECK_MESSAGE(has(outcome.err, why), arguments << ": " << outcome.err);
  };
  refused("info text.mcap", "text.mcap: is not an MCAP file");
  refused("info gone.mcap", "gone.mcap: there is no such file");
  refused("csv run.mcap base.tild_rad", "unknown signal 'base.tild_rad', did you mean 'base.tilt_rad'?");
  refused("cat run.mcap --topic jont", "unknown topic '/jont', did you mean '/joint'?");
  refused("cat run.mcap --from 7", "it goes from 0.000 s to 0.499 s");
  refused("csv run.mcap --from 0.3 --to 0.2", "--to: 0.2 s is before --from 0.3 s");
  refused("csv run.mcap -o there.csv", "there.csv: is there already; --force replaces it");
  refused("cut run.mcap -o ./run.mcap --force", "is the record itself");
  refused("plot run.mcap base.tilt_rad -o plot.pdf", "ends with .svg or .png");
  refused("plot run.mcap '*' -o plot.svg", "choose fewer");
  refused("infos run.mcap", "did you mean 'info'?");
  CHECK(read(folder / "there.csv") == "precious");
  CHECK(run("log csv run.mcap base.tilt_rad -o there.csv --force", folder).exit_code == 0);
  CHECK(lines_in(read(folder / "there.csv")) == 501);
  for (const auto& file : fs::directory_iterator(folder)) CHECK(file.path().extension() != ".part");
}

TEST_CASE("log plot sketches in the terminal, draws with gnuplot, and says how to get that") {
  const fs::path folder = records("log_plot");
  const Outcome sketch = run("log plot run.mcap base.height_m joint.l_knee.effort_Nm", folder);
  CHECK(sketch.exit_code == 0);
  CHECK(has(sketch.out, "base.height_m, m"));
  CHECK(has(sketch.out, "⠤") + has(sketch.out, "⣀") + has(sketch.out, "⠒") + has(sketch.out, "⠉") > 0);
  {
    const EmptyPath nothing;
    const Outcome missing = run("log plot run.mcap base.height_m -o plot.svg", folder);
    CHECK(missing.exit_code == 2);
    CHECK(has(missing.err, "install the package gnuplot-nox"));
    CHECK_FALSE(fs::exists(folder / "plot.svg"));
  }
  if (std::system("gnuplot --version >/dev/null 2>&1") != 0) return;  // NOLINT: the shell's PATH
  CHECK(run("log plot run.mcap base.height_m joint.l_knee -o plot.svg", folder).exit_code == 0);
  CHECK(has(read(folder / "plot.svg"), "joint.l_knee.velocity_rad_s"));
  CHECK(run("log plot run.mcap base.height_m -o plot.png", folder).exit_code == 0);
  CHECK(has(read(folder / "plot.png").substr(0, 8), "PNG"));
}
