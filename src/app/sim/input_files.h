// The files that a run reads: collects them, compares them with those of a record, and unpacks those of a record.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "app/commands.h"
#include "app/run/run_choices.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {

// The files of a run, sorted by path. Scenario, robot, URDF, and behaviors with their modules have their text. Plug-ins
// have only a hash, and so have files that the robot's record.private names. Meshes have only a name, because nothing
// is computed from them. Throws InputError for a pattern of record.private that no file of the project has.
std::vector<InputFile> input_files(const ScenarioConfig& scenario, const Assembly& assembly);

// Of its links, in their order.
std::vector<std::filesystem::path> mesh_files(const RobotModel& model);

// All inputs of the run that `choices` asks for, for its record.
RunInputs inputs_of(const RunChoices& choices, const ScenarioConfig& scenario, const Assembly& assembly);

// The same for a run on threads: `options` are what was asked for, `assembly` what was made of it.
RunInputs inputs_of(const RunOptions& options, const ScenarioConfig& scenario, const Assembly& assembly);
// And back: what was asked for, without its files. Throws InputError that names the record.
RunOptions options_of(const RunInputs& inputs, const std::string& record);
InputLayout layout_of(const Assembly& assembly);            // of the inputs of its ticks
inline constexpr const char* clock_of_threads = "threads";  // as the fact "clock" of such a run
// The same of a scenario that another program stepped (kadans/app/simulation.h).
inline constexpr const char* clock_of_programs = "program";

// An input that is no longer the same.
struct InputChange {
  std::string what;  // path of a file, or part of the program
  std::string how;   // "changed", "is gone", "is new"
};
// Compares the files around the scenario with the recorded ones. `added` are the files that the run reads now; those
// that the record lacks are new.
std::vector<InputChange> changed_files(const RunInputs& recorded, const std::filesystem::path& scenario,
                                       const std::vector<InputFile>& added);
std::vector<InputChange> changed_program(const RunInputs& recorded);
// The build of Bullet that this program has loaded: "libBulletDynamics-float64.so.3.24 263ffefc".
std::string bullet_build();
// "behaviors/tulip/squat.lua changed, libm.so.6 changed"
std::string change_text(const std::vector<InputChange>& changes);

// The gate for a record whose scenario is on this disk: the plug-ins of its project are loaded when it is the project
// around the working directory, or when `any_plugins` is true.
PluginGate plugins_beside(const std::filesystem::path& scenario, bool any_plugins);

// Reads the inputs at the front of a record. Throws InputError when the record cannot be run again.
RunInputs read_front(const std::string& record);
// Whether the record holds a run's last seconds, from saved states of the control engine on.
bool is_flight_record(const std::string& record);

// Finds the scenario of a record: at its recorded path, in the project around the working directory, or in the project
// around the record. Throws InputError when it is in none of them.
std::filesystem::path find_scenario(const RunInputs& recorded, const std::filesystem::path& record);

// Unpacks the files of a record into a private temporary folder, which is removed with this object. Only new files are
// made, so no existing file is written to and no link is followed. Native code never comes out of a record: a plug-in
// is taken from the same path in the project around the working directory, and only if its hash is the recorded one or
// `any_plugins` is true.
class UnpackedInputs {
 public:
  // `with`: files of a project here that take the place of the record's, also of a plug-in. Throws InputError when the
  // record lacks its scenario, when a file cannot be written, or when a plug-in or a private file is not here or
  // differs.
  UnpackedInputs(const RunInputs& recorded, const std::string& record, bool any_plugins,
                 const std::vector<std::string>& with = {});
  ~UnpackedInputs();
  UnpackedInputs(const UnpackedInputs&) = delete;
  UnpackedInputs& operator=(const UnpackedInputs&) = delete;

  // Adds the behaviors of the project around the working directory that the record lacks, so that they can be played.
  // They become inputs of the run.
  void add_behaviors(RunInputs& inputs) const;
  // Another text of a file, or one that came later; those of `with` stay. Throws InputError when the path leads out of
  // the folder, or when a plug-in stands there.
  void replace(const InputFile& file) const;
  // A private file of the record: from the project around the working directory. Throws InputError when it is not there
  // or differs.
  void fetch(const InputFile& file, const std::string& record) const;

  const std::filesystem::path& root() const noexcept { return folder_; }
  const std::filesystem::path& scenario() const noexcept { return scenario_; }
  const PluginGate& plugins() const noexcept { return plugins_; }

 private:
  void remove() const noexcept;
  void unpack(const InputFile& file) const;
  void link_plugin(const InputFile& file, const std::string& record, bool any_plugins);

  std::filesystem::path folder_, scenario_;
  std::set<std::string> given_;  // names of `with`
  PluginGate plugins_;
  int owner_;  // process that removes the folder; a process that split off later does not
};

}  // namespace kadans
