// Records and checkpoints that somebody sends: what they bring is unpacked beside everything that is here, and none of
// it runs as native code.
#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/program.h"
#include "app/sim/input_files.h"
#include "kadans/signal/input_error.h"
#include "telemetry/record/run_inputs.h"

namespace foreign_record_test {

using namespace kadans;
using namespace kadans::program;

namespace {

namespace fs = std::filesystem;

constexpr const char* plugin_source = KADANS_BINARY_DIR "/tests/plugins/loaded_plugin.so";

InputFile input(const std::string& path, const std::string& text) { return {path, content_hash(text), text}; }

// A project with a record of a short run and a checkpoint of it.
struct Sent {
  fs::path project, elsewhere;
  fs::path loaded;  // there as soon as the plug-in is

  explicit Sent(const std::string& name, bool with_plugin = false)
      : project(project_copy(name)), elsewhere(fresh_folder(name + "_elsewhere")), loaded(elsewhere / "loaded") {
    if (with_plugin) {
      fs::copy(plugin_source, project / "models/own.so");
      list_plugin(project / "config/tulip/robot.json", "models/own.so");
    }
    const Outcome outcome =
        run("sim config/scenarios/squat.json --duration 0.3 --record run.mcap --checkpoint 0.2=at.mcap", project);
    REQUIRE_MESSAGE(fs::exists(project / "at.mcap"), outcome.err);
    setenv("KADANS_TEST_LOADED", loaded.c_str(), 1);
  }
  ~Sent() { unsetenv("KADANS_TEST_LOADED"); }
  Sent(const Sent&) = delete;
  Sent& operator=(const Sent&) = delete;

  static void list_plugin(const fs::path& robot, const std::string& plugin) {
    REQUIRE(edit(robot, "\"name\": \"tulip\",", "\"name\": \"tulip\", \"plugins\": [\"" + plugin + "\"],"));
  }
  RunInputs inputs() const {
    McapReader reader((project / "run.mcap").string());
    McapMessage message;
    (void)reader.next(message);
    return read_inputs(reader, "run.mcap");
  }
  // Their robot lists a plug-in.
  static void list_plugin(RunInputs& inputs, const std::string& plugin) {
    const auto robot = std::ranges::find(inputs.files, "config/tulip/robot.json", &InputFile::path);
    const std::string name = "\"name\": \"tulip\",";
    robot->text->replace(robot->text->find(name), name.size(), name + " \"plugins\": [\"" + plugin + "\"],");
    *robot = input(robot->path, *robot->text);
  }
  // As a stranger writes it.
  fs::path forged(const RunInputs& inputs) const {
    McapWriter writer;
    REQUIRE(writer.open((elsewhere / "forged.mcap").string()));
    REQUIRE(write_inputs(writer, inputs));
    REQUIRE(writer.add_metadata("checkpoint", {{"tick", "100"}, {"time_ns", "100000000"}, {"state_hash", "0"}}));
    REQUIRE(writer.close());
    return elsewhere / "forged.mcap";
  }
};

// The working directory is this one, for a while.
class Inside {
 public:
  explicit Inside(const fs::path& folder) { fs::current_path(folder); }
  ~Inside() { fs::current_path(before_); }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

 private:
  fs::path before_ = fs::current_path();
};

// Both ways to what a record holds.
const std::vector<std::string> ways{"replay forged.mcap --from-record", "sim --from forged.mcap --no-record"};

}  // namespace

TEST_CASE("A record writes nothing outside of its folder, whatever its files are called") {
  const Sent sent("foreign_paths");
  fs::create_directories(sent.elsewhere / "scripts");
  for (const std::string name :
       {"scripts/./x.sh", "scripts//x.sh", "./x.sh", "../x.sh", "a/../../x.sh", "scripts/", "."}) {
    CAPTURE(name);
    RunInputs inputs = sent.inputs();
    inputs.files.push_back(input(name, "theirs"));
    (void)sent.forged(inputs);
    for (const std::string& way : ways) {
      const Outcome outcome = run(way, sent.elsewhere);
      CHECK(outcome.exit_code == 2);
      CHECK(has(outcome.err, "is no path inside a project"));
    }
  }
}

TEST_CASE("A record writes nothing through the link that a plug-in of this project becomes in its folder") {
  const Sent sent("foreign_link", true);
  const fs::path plugin = sent.project / "models/own.so";
  const std::string bytes = read(plugin);
  const auto told = [&](const RunInputs& inputs, const std::string& way) {
    (void)sent.forged(inputs);
    fs::copy_file(sent.elsewhere / "forged.mcap", sent.project / "forged.mcap", fs::copy_options::overwrite_existing);
    fs::remove(sent.loaded);
    return run(way, sent.project);
  };
  for (const std::string& way : ways) {
    CAPTURE(way);
    (void)told(sent.inputs(), way);
    CHECK(fs::exists(sent.loaded));  // so the link is made, and the plug-in is loaded through it
    for (const std::string through : {"models/own.so/x", "models/own.so/a/b"}) {
      for (const InputFile& file : {input(through, "theirs"), InputFile{through, "", std::nullopt}}) {
        CAPTURE(through);
        RunInputs inputs = sent.inputs();
        inputs.files.push_back(file);
        const Outcome outcome = told(inputs, way);
        CHECK(outcome.exit_code == 2);
        CHECK_MESSAGE(has(outcome.err, "its files cannot be unpacked"), outcome.err);
        CHECK_FALSE(fs::exists(sent.loaded));
        CHECK(read(plugin) == bytes);
      }
    }
  }
}

TEST_CASE("Unpacking refuses a file in the place of a plug-in's link, and a link in the place of a file") {
  const fs::path project = project_copy("foreign_same");
  write(project / "models/own.so", "mine");
  const InputFile plugin{"models/own.so", content_hash("mine"), std::nullopt};
  const InputFile text = input("models/own.so", "theirs"), scenario = input("config/s.json", "{}");
  const auto refusal = [&](const std::vector<InputFile>& files) {
    const Inside inside(project);
    try {
      const UnpackedInputs unpacked({.run = {{"scenario_input", scenario.path}}, .program = {}, .files = files},
                                    "forged.mcap", false);
      return fs::is_symlink(unpacked.scenario().parent_path().parent_path() / "models/own.so") ? std::string("linked")
                                                                                               : std::string("a file");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  CHECK(refusal({scenario, plugin}) == "linked");
  CHECK(refusal({scenario, text}) == "a file");
  CHECK_MESSAGE(has(refusal({scenario, plugin, text}), "models/own.so: is there already"),
                refusal({scenario, plugin, text}));
  CHECK_MESSAGE(has(refusal({scenario, text, plugin}), "its files cannot be unpacked"),
                refusal({scenario, text, plugin}));
  CHECK(read(project / "models/own.so") == "mine");
}

TEST_CASE("A file that a recorded run read later replaces a file of the record, and nothing else") {
  const fs::path project = project_copy("foreign_later");
  write(project / "models/own.so", "mine");
  const Inside inside(project);
  const InputFile plugin{"models/own.so", content_hash("mine"), std::nullopt}, scenario = input("config/s.json", "{}");
  const UnpackedInputs unpacked(
      {.run = {{"scenario_input", scenario.path}}, .program = {}, .files = {scenario, plugin}}, "forged.mcap", false);
  const auto refusal = [&](const char* path) {
    try {
      unpacked.replace(input(path, "theirs"));
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  CHECK(refusal("config/s.json").empty());
  CHECK(read(unpacked.scenario()) == "theirs");
  CHECK(refusal("behaviors/new/one.lua").empty());
  CHECK(read(unpacked.root() / "behaviors/new/one.lua") == "theirs");
  CHECK_MESSAGE(has(refusal("models/own.so"), "models/own.so: is a plug-in"), refusal("models/own.so"));
  for (const char* outside : {"../stray", "config/../../stray", "/tmp/stray", ""})
    CHECK_MESSAGE(has(refusal(outside), "leads out of the record's files"), outside);
  CHECK_MESSAGE(has(refusal("models"), "is there already"), refusal("models"));
  CHECK_MESSAGE(has(refusal("config/s.json/below.lua"), "cannot be unpacked"), refusal("config/s.json/below.lua"));
  CHECK(read(project / "models/own.so") == "mine");
}

TEST_CASE("Native code that a record brings is not loaded, whatever its robot lists") {
  const Sent sent("foreign_native");
  for (const std::string& listed : {std::string("models/evil.so"), (sent.elsewhere / "evil.so").string()}) {
    CAPTURE(listed);
    fs::copy(plugin_source, sent.elsewhere / "evil.so", fs::copy_options::overwrite_existing);
    RunInputs inputs = sent.inputs();
    inputs.files.push_back(input("models/evil.so", read(plugin_source)));
    Sent::list_plugin(inputs, listed);
    (void)sent.forged(inputs);
    for (const std::string& way : ways) {
      const Outcome outcome = run(way, sent.elsewhere);
      CHECK(outcome.exit_code == 2);
      CHECK(has(outcome.err, "robot.json:"));
      CHECK(has(outcome.err, "native code does not come out of a record"));
    }
    CHECK_FALSE(fs::exists(sent.loaded));
  }
}

TEST_CASE("A record's plug-in is none that lies elsewhere on this machine, although its path and content are known") {
  const Sent sent("foreign_absolute");
  const std::string listed = (fs::temp_directory_path() / ("kadans-" + std::to_string(getpid()) + ".so")).string();
  fs::copy(plugin_source, listed, fs::copy_options::overwrite_existing);
  RunInputs inputs = sent.inputs();
  inputs.files.push_back({listed, content_hash(read(plugin_source)), std::nullopt});
  Sent::list_plugin(inputs, listed);
  (void)sent.forged(inputs);
  for (const std::string& way : ways) {
    const Outcome outcome = run(way, sent.elsewhere);
    CHECK(outcome.exit_code == 2);
    CHECK_MESSAGE(has(outcome.err, "which is not in the project around the working directory"), outcome.err);
  }
  CHECK_FALSE(fs::exists(sent.loaded));
  fs::remove(listed);
}

TEST_CASE("What a record brings is bounded before it is unpacked, all of it together") {
  const Sent sent("foreign_bomb");
  RunInputs inputs = sent.inputs();
  for (int i = 0; i < 3; ++i)
    inputs.files.push_back(input("models/" + std::to_string(i), std::string(std::size_t{24} << 20U, ' ')));
  (void)sent.forged(inputs);
  for (const std::string& way : ways) {
    const Outcome outcome = run(way, sent.elsewhere);
    CHECK(outcome.exit_code == 2);
    CHECK_MESSAGE(has(outcome.err, "models/2.zst is damaged or too large"), outcome.err);
  }
}

TEST_CASE("A checkpoint whose tick never comes is no run that passed") {
  const Sent sent("foreign_tick");
  McapWriter writer;
  REQUIRE(writer.open((sent.elsewhere / "late.mcap").string()));
  REQUIRE(write_inputs(writer, sent.inputs()));
  REQUIRE(writer.add_metadata("checkpoint", {{"tick", "99999"}, {"time_ns", "100000000"}, {"state_hash", "0"}}));
  REQUIRE(writer.close());
  const Outcome outcome = run("sim --from late.mcap --no-record", sent.elsewhere);
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.err, "without coming to the tick of the checkpoint, 99999"));
}

TEST_CASE("A record's plug-in is the one of this project when it is the same, or when that is allowed") {
  const Sent sent("foreign_plugin", true);
  fs::copy(sent.project / "run.mcap", sent.elsewhere / "run.mcap");
  fs::copy(sent.project / "at.mcap", sent.elsewhere / "at.mcap");
  const std::vector<std::string> both{"replay run.mcap --from-record", "sim --from at.mcap --no-record"};
  for (const std::string& way : both) {
    const Outcome none = run(way, sent.elsewhere);
    CHECK(none.exit_code == 2);
    CHECK(has(none.err, "needs the plug-in models/own.so, which is not in this project"));
    const Outcome same = run(way, sent.project);
    CHECK_MESSAGE(same.exit_code == 0, same.err);
  }
  CHECK(fs::exists(sent.loaded));
  fs::remove(sent.loaded);
  write(sent.project / "models/own.so", read(plugin_source) + "more");
  for (const std::string& way : both) {
    const Outcome other = run(way, sent.project);
    CHECK(other.exit_code == 2);
    CHECK(has(other.err, "--allow-plugins"));
    CHECK_FALSE(fs::exists(sent.loaded));
  }
  CHECK(run(both[0] + " --allow-plugins", sent.project).exit_code == 0);
  CHECK(run(both[1] + " --allow-plugins", sent.project).exit_code == 0);
}

TEST_CASE("A record beside a project of its own does not load that project's plug-ins from elsewhere") {
  const Sent sent("foreign_beside", true);
  const std::string record = "'" + (sent.project / "run.mcap").string() + "'";
  const Outcome refused = run("replay " + record, sent.elsewhere);
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "--allow-plugins"));
  CHECK_FALSE(fs::exists(sent.loaded));
  const Outcome allowed = run("replay --allow-plugins " + record, sent.elsewhere);
  CHECK_MESSAGE(allowed.exit_code == 0, allowed.err);
}

TEST_CASE("A record that names a scenario outside of all projects does not load the plug-ins that lie there") {
  const Sent sent("foreign_loose");
  const fs::path loose = fresh_folder("foreign_loose_files");
  fs::copy(plugin_source, loose / "evil.so");
  write(loose / "robot.json", R"({"name": "x", "plugins": ["./evil.so"]})");
  write(loose / "s.json", R"({"name": "s", "robot": "./robot.json", "duration_s": 1})");
  RunInputs inputs = sent.inputs();
  for (const std::string& scenario :
       {(loose / "s.json").string(), fs::relative(loose / "s.json", sent.project).string()}) {
    inputs.run["scenario"] = scenario;
    const Outcome refused = run("replay '" + sent.forged(inputs).string() + "'", sent.project);
    CHECK(refused.exit_code == 2);
    CHECK_MESSAGE(has(refused.err, "--allow-plugins"), refused.err);
    CHECK_FALSE(fs::exists(sent.loaded));
    fs::remove(sent.elsewhere / "forged.mcap");
  }
}

TEST_CASE("Files that are devices, pipes or folders are refused where a file is wanted, and nothing waits for them") {
  const fs::path folder = project_copy("no_files");
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  for (const char* name : {"pipe.lua", "pipe.json", "pipe.urdf", "pipe.mcap"})
    fs::create_symlink("pipe", folder / name);
  for (const char* name : {"zero.lua", "zero.json", "zero.urdf", "zero.mcap"})
    fs::create_symlink("/dev/zero", folder / name);
  fs::create_symlink("pipe", folder / "behaviors/tulip/pipe.lua");
  for (const std::string kind : {"pipe", "zero"}) {
    for (const std::string& command :
         {"check " + kind + ".lua --robot config/tulip/robot.json", "check " + kind + ".json",
          "check " + kind + ".urdf", "behavior check " + kind + ".lua --robot config/tulip/robot.json",
          "log info " + kind + ".mcap", "log diff " + kind + ".mcap " + kind + ".mcap", "replay " + kind + ".mcap",
          "sim --from " + kind + ".mcap", "view " + kind + ".mcap", "sim " + kind + ".json",
          "run " + kind + ".json --soft"}) {
      CAPTURE(command);
      const Outcome outcome = run(command, folder);
      CHECK(outcome.exit_code == 2);
      CHECK(has(outcome.err, "a device, a pipe or a socket"));
    }
  }
  CHECK(run("sim config/scenarios/squat.json --play pipe --duration 0.1 --no-record", folder).exit_code == 2);
}

TEST_CASE("A message of a record that nests deep crashes no command that reads records") {
  const fs::path folder = fresh_folder("deep_record");
  McapWriter writer;
  REQUIRE(writer.open((folder / "deep.mcap").string()));
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  for (const auto& [schema, topic] : {std::pair{"foxglove.Log", "/log"}, std::pair{"kadans.Transition", "/transitions"},
                                      std::pair{"kadans.Fault", "/faults"}, std::pair{"other", "/other"}}) {
    const std::uint16_t id = writer.add_schema(schema, "jsonschema", "{}");
    const std::uint16_t channel = writer.add_channel(topic, "json", id);
    REQUIRE(writer.write(channel, 0, 1, std::as_bytes(std::span(deep.data(), deep.size()))));
  }
  REQUIRE(writer.close());
  for (const char* command :
       {"log info deep.mcap", "log cat deep.mcap", "log csv deep.mcap", "log cut deep.mcap -o cut.mcap",
        "log diff deep.mcap deep.mcap", "log plot deep.mcap x -o x.svg"}) {
    CAPTURE(command);
    CHECK(run(command, folder).exit_code <= 2);
  }
}

TEST_CASE("check loads no plug-in that a file names, unless it is told to, and says so") {
  const Sent sent("check_plugins", true);
  fs::remove(sent.loaded);
  const Outcome robot = run("check config/tulip/robot.json", sent.project);
  CHECK(robot.exit_code == 0);
  CHECK(has(robot.out, "its plug-ins were not loaded"));
  for (const char* file :
       {"config/scenarios/squat.json", "behaviors/tulip/squat.lua", "config/sweeps/push_varied.json"}) {
    const Outcome outcome = run(std::string("check ") + file, sent.project);
    CHECK(outcome.exit_code == 2);
    CHECK_MESSAGE(has(outcome.err, "--plugins"), outcome.err);
  }
  CHECK(run("behavior check behaviors/tulip/squat.lua", sent.project).exit_code == 2);
  CHECK_FALSE(fs::exists(sent.loaded));
  CHECK(run("check --plugins config/scenarios/squat.json", sent.project).exit_code == 0);
  CHECK(fs::exists(sent.loaded));
}

}  // namespace foreign_record_test
