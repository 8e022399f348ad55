#include "input_files.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <span>
#include <string>
#include <system_error>

#include <elf.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include "config/json/problems.h"
#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/machine_name.h"
#include "kadans/signal/nearest_name.h"
#include "signal/byte_order.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/input_stream.h"
#include "version.h"

namespace kadans {
namespace {

// The build id in a segment of ELF notes; "" when there is none. A note is its head, its name and its content, each
// padded to four bytes.
std::string build_id(const unsigned char* notes, std::size_t size) {
  const auto padded = [](std::size_t length) { return (length + 3) / 4 * 4; };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) head{};
    std::memcpy(&head, notes + at, sizeof head);
    const std::size_t name = at + sizeof head, content = name + padded(head.n_namesz);
    if (content + head.n_descsz > size) break;
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && std::memcmp(notes + name, "GNU", 4) == 0)
      return hexadecimal(std::as_bytes(std::span(notes + content, head.n_descsz)));
    at = content + padded(head.n_descsz);
  }
  return {};
}

int add_part(dl_phdr_info* info, std::size_t, void* target) {
  const std::string path = info->dlpi_name;
  const std::string file = path.substr(path.rfind('/') + 1);
  if (file.starts_with("linux-")) return 0;  // mapped by the kernel into every process
  std::string id;
  for (int i = 0; i < info->dlpi_phnum && id.empty(); ++i) {
    const ElfW(Phdr)& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    id = build_id(reinterpret_cast<const unsigned char*>(info->dlpi_addr + segment.p_vaddr), segment.p_memsz);
  }
  (*static_cast<TextMap*>(target))[file.empty() ? "kadans" : file] = id;
  return 0;
}

// The exact parts of the running program: its version, and the linker's build id of the program and of each loaded
// shared library. Two programs with the same parts compute the same numbers from the same inputs. The names are
// "kadans", "version", "machine", "libm.so.6" ...; a part without a build id has "".
TextMap program_parts() {
  TextMap parts{{"version", version}, {"machine", machine_name()}};
  dl_iterate_phdr(add_part, &parts);
  return parts;
}

namespace fs = std::filesystem;

constexpr const char* beside = "beside";
constexpr std::size_t input_max_bytes = std::size_t{256} << 20U;  // large enough for a plug-in, which is only hashed

// From the folder on; "": the file is not in it.
std::string name_below(const fs::path& folder, const fs::path& file) {
  const fs::path relative = file.lexically_relative(folder);
  return relative.empty() || *relative.begin() == ".." ? "" : relative.generic_string();
}

// The two folders at which paths in a record start.
struct Folders {
  fs::path root, own;

  explicit Folders(const fs::path& scenario)
      : root(project_root(scenario)), own(fs::absolute(scenario).lexically_normal().parent_path()) {}

  std::string name(const fs::path& file) const {
    const fs::path whole = fs::absolute(file).lexically_normal();
    if (std::string name = name_below(root, whole); !name.empty()) return name;
    if (const std::string name = name_below(own, whole); !name.empty()) return std::string(beside) + "/" + name;
    return whole.generic_string();
  }
  fs::path file(const std::string& name) const {
    const fs::path path(name);
    if (path.is_absolute()) return path;
    return *path.begin() == beside ? own / path.lexically_relative(beside) : root / path;
  }
};

std::optional<std::string> read_all(const fs::path& file) {
  try {
    return read_input_file(file, input_max_bytes);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

// The path of a file from the root of its project.
std::string name_in_project(const std::string& file) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(whole, error)) refuse(file, "there is no such file");
  std::string name = name_below(project_root(whole), whole);
  if (name.empty()) refuse(file, "lies in no project, so it has no place in the record");
  return name;
}

// The project around the working directory.
fs::path project_here() { return project_root(fs::current_path() / "x"); }

bool is_own(const fs::path& file) {
  struct stat found {};
  return stat(file.c_str(), &found) == 0 && (found.st_uid == getuid() || found.st_uid == 0);
}

// A file that ought to be private must not go out because of a slip in its
// pattern, so one that no file of the project has is refused.
void refuse_unknown_private(const RobotConfig& robot) {
  const Folders folders(robot.file);
  Problems problems(robot.file);
  for (const PlacedName& pattern : robot.record.private_files) {
    bool found = false;
    for (const char* folder : {"config", "models", "behaviors"}) {
      std::error_code none;
      for (fs::recursive_directory_iterator entry(folders.root / folder, none), end; !found && entry != end;
           entry.increment(none))
        found = matches(pattern.name, folders.name(entry->path()));
    }
    if (!found)
      problems.add(pattern.place, "record.private: no file in config, models or behaviors of this project is called " +
                                      in_quotes(pattern.name));
  }
  problems.throw_if_any();
}

class Gathering {
 public:
  Gathering(const fs::path& scenario, const Assembly& assembly) : folders_(scenario) {
    know_private(assembly.robot());
    for (const auto& other : assembly.others()) know_private(other->robot());
  }

  void add(const fs::path& file) {
    std::string text = read_all(file).value_or("");
    std::string hash = content_hash(text), name = folders_.name(file);
    const bool left_out =
        std::ranges::any_of(private_, [&](const std::string& pattern) { return matches(pattern, name); });
    put({std::move(name), std::move(hash), left_out ? std::nullopt : std::optional(std::move(text)), left_out});
  }
  void add_hash(const fs::path& file) {
    put({folders_.name(file), content_hash(read_all(file).value_or("")), std::nullopt});
  }
  void add_name(const fs::path& file) { put({folders_.name(file), "", std::nullopt}); }

  std::vector<InputFile> take() {
    std::vector<InputFile> files;
    for (auto& [name, file] : files_) files.push_back(std::move(file));
    return files;
  }

 private:
  void put(InputFile file) {
    const std::string name = file.path;
    files_.insert_or_assign(name, std::move(file));
  }
  void know_private(const RobotConfig& robot) {
    refuse_unknown_private(robot);
    std::ranges::copy(names_of(robot.record.private_files), std::back_inserter(private_));
  }

  Folders folders_;
  std::vector<std::string> private_;
  std::map<std::string, InputFile> files_;
};

// The scripts in behaviors/FOLDER.
void add_scripts(const fs::path& project_file, const std::string& folder, Gathering& files) {
  for (const std::string& name : playable_names({project_file, folder}))
    files.add(project_root(project_file) / "behaviors" / folder / (name + ".lua"));
}

void add_robot(const Assembly& assembly, Gathering& files) {
  const RobotConfig& robot = assembly.robot();
  for (const fs::path& file : mesh_files(robot.model)) files.add_name(file);
  if (!robot.plugins.empty()) {
    for (const PluginFile& plugin : read_plugin_files(robot.file)) files.add_hash(plugin.file);
  }
  for (const fs::path& file : files_of(robot.file)) files.add(file);
  files.add(robot.model.file);
  for (const BehaviorValue& given : robot.behavior_values) files.add(project_root(robot.file) / given.chunk);
  if (const ScriptHost* host = assembly.own_host()) {
    for (const fs::path& file : host->files()) files.add(file);
  }
  for (const PlayItem& item : assembly.supervising().lost_list) files.add(item.file);
  if (const Supervisor* supervisor = assembly.supervisor(); supervisor != nullptr && supervisor->decider() != nullptr) {
    for (const fs::path& file : supervisor->decider()->files()) files.add(file);
    const PlayFolders folders = folders_of(assembly.scenario());  // what they may play is in
    add_scripts(folders.project_file, folders.robot, files);
    add_scripts(folders.project_file, "lib", files);
  }
  for (const ScenarioPerception& one : assembly.scenario().perception) {
    if (!one.record.name.empty()) files.add(one.record.name);
  }
  for (const auto& other : assembly.others()) add_robot(*other, files);
}

}  // namespace

std::vector<fs::path> mesh_files(const RobotModel& model) {
  std::vector<fs::path> files;
  for (const Link& link : model.links) {
    for (const auto* list : {&link.collisions, &link.visuals}) {
      for (const Geometry& geometry : *list) {
        if (const Mesh* mesh = std::get_if<Mesh>(&geometry.shape)) files.emplace_back(mesh->file);
      }
    }
  }
  return files;
}

std::vector<InputFile> input_files(const ScenarioConfig& scenario, const Assembly& assembly) {
  Gathering files(scenario.file, assembly);
  for (const fs::path& file : files_of(scenario.file)) files.add(file);
  if (!scenario.joystick.recording.empty()) files.add(scenario.joystick.recording);
  add_robot(assembly, files);
  return files.take();
}

RunInputs inputs_of(const RunChoices& choices, const ScenarioConfig& scenario, const Assembly& assembly) {
  RunInputs inputs{.run = {{"scenario", scenario.file},
                           {"scenario_input", Folders(scenario.file).name(scenario.file)},
                           {"kadans", version},
                           {"clock", "virtual"}},
                   .program = program_parts(),
                   .files = input_files(scenario, assembly)};
  put_facts(choices, inputs.run);
  return inputs;
}

RunInputs inputs_of(const RunOptions& options, const ScenarioConfig& scenario, const Assembly& assembly) {
  RunInputs inputs{.run = {{"robot", scenario.robot},
                           {"scenario", scenario.file},
                           {"scenario_input", Folders(scenario.file).name(scenario.file)},
                           {"kadans", version},
                           {"clock", clock_of_threads},
                           {"seed", std::to_string(scenario.seed)},
                           {"plant", options.plant},
                           {"play", options.play},
                           {"behaviors", options.behaviors}},
                   .program = program_parts(),
                   .files = {}};
  inputs.run["root"] = project_root(scenario.file).string();
  if (!options.peer.empty()) inputs.run["peer"] = options.peer;
  if (!options.imu.empty()) inputs.run["imu"] = options.imu;
  if (!options.joystick.empty()) inputs.run["joystick"] = options.joystick;
  if (options.read_only) inputs.run["read_only"] = "yes";
  if (options.virtual_time) inputs.run["virtual_time"] = "yes";
  Gathering files(scenario.file, assembly);
  add_robot(assembly, files);
  if (assembly.own_host() == nullptr) {  // they play in another process, which has read them
    BehaviorLog silence;
    for (const fs::path& file :
         make_script_host(scenario, assembly.robot(), assembly.catalog(), scenario.seed, silence)->files())
      files.add(file);
  }
  inputs.files = files.take();
  return inputs;
}

InputLayout layout_of(const Assembly& assembly) {
  const RobotConfig& robot = assembly.robot();
  return {.joints = static_cast<std::uint32_t>(robot.model.joints.size()),
          .feet = static_cast<std::uint32_t>(robot.plant.feet.size()),
          .channels = static_cast<std::uint32_t>(robot.plant.channels.size()),
          .down = static_cast<std::uint32_t>(assembly.sets().hand_overs().down.size()),
          .seen = static_cast<std::uint32_t>(assembly.catalog().seen.size())};
}

RunOptions options_of(const RunInputs& inputs, const std::string& record) {
  RunOptions options;
  const auto seed = number_of<std::uint64_t>(inputs.fact("seed"));
  if (!seed || inputs.fact("plant").empty()) refuse(record, "is damaged: it does not say how its run was begun");
  options.seed = *seed;
  options.plant = inputs.fact("plant");
  options.play = inputs.fact("play");
  options.behaviors = inputs.fact("behaviors");
  options.peer = inputs.fact("peer");
  options.imu = inputs.fact("imu");
  options.joystick = inputs.fact("joystick");
  options.read_only = !inputs.fact("read_only").empty();
  options.virtual_time = !inputs.fact("virtual_time").empty();
  return options;
}

std::vector<InputChange> changed_files(const RunInputs& recorded, const fs::path& scenario,
                                       const std::vector<InputFile>& added) {
  const Folders folders(scenario);
  std::vector<InputChange> changes;
  for (const InputFile& file : recorded.files) {
    if (file.hash.empty()) continue;
    const std::optional<std::string> now = read_all(folders.file(file.path));
    if (!now) {
      changes.push_back({file.path, "is gone"});
    } else if (content_hash(*now) != file.hash) {
      changes.push_back({file.path, "changed"});
    }
  }
  for (const InputFile& file : added) {
    if (std::ranges::find(recorded.files, file.path, &InputFile::path) == recorded.files.end())
      changes.push_back({file.path, "is new"});
  }
  return changes;
}

std::vector<InputChange> changed_program(const RunInputs& recorded) {
  std::vector<InputChange> changes;
  const TextMap now = program_parts();
  for (const auto& [part, id] : recorded.program) {
    const auto found = now.find(part);
    if (found == now.end()) {
      changes.push_back({part, "is gone"});
    } else if (found->second != id) {
      const bool telling = part == "version" || part == "machine";
      changes.push_back({part == "kadans" ? "the program" : part,
                         telling ? "changed from " + id + " to " + found->second : "changed"});
    }
  }
  for (const auto& [part, id] : now) {
    if (!recorded.program.contains(part)) changes.push_back({part, "is new"});
  }
  return changes;
}

std::string bullet_build() {
  constexpr std::size_t digits = 8;
  for (const auto& [part, id] : program_parts()) {
    if (part.starts_with("libBulletDynamics")) return part + " " + id.substr(0, digits);
  }
  return "no Bullet";
}

std::string change_text(const std::vector<InputChange>& changes) {
  return listed(changes, [](const InputChange& change) { return change.what + " " + change.how; });
}

fs::path find_scenario(const RunInputs& recorded, const fs::path& record) {
  const fs::path written = recorded.fact("scenario");
  const std::string name = recorded.fact("scenario_input");
  std::vector<fs::path> places{written};
  if (!name.starts_with(std::string(beside) + "/")) {
    places.push_back(project_here() / name);
    places.push_back(project_root(record) / name);
  }
  for (const fs::path& place : places) {
    std::error_code ignored;
    if (fs::is_regular_file(place, ignored)) return place;
  }
  refuse(record, "its scenario " + written.string() + " is not here; run this in its project, or with --from-record");
}

RunInputs read_front(const std::string& record) {
  McapReader reader(record);
  McapMessage message;
  const bool holds_messages = reader.next(message);
  RunInputs inputs = read_inputs(reader, record);
  if (inputs.run.empty()) {
    refuse(record, holds_messages || reader.complete() ? "was not recorded by kadans"
                                                       : "ends before it begins: " + reader.problem());
  }
  const std::string clock = inputs.fact("clock");
  if (clock == clock_of_programs)
    refuse(record, "was stepped by another program, which alone repeats it" +
                       (inputs.fact("repeat").empty() ? "" : ": " + inputs.fact("repeat")));
  if (!clock.empty() && clock != "virtual" && clock != clock_of_threads)
    refuse(record, "was made by another version of kadans: it says that its clock is " + in_quotes(clock));
  const bool of_robot = clock == clock_of_threads || (clock.empty() && inputs.run.contains("robot"));
  const auto layout = reader.metadata().find(inputs_metadata);
  if (of_robot && layout == reader.metadata().end())
    refuse(
        record,
        "holds no inputs of its ticks, so what went into the run cannot be had again: it was begun while its run went "
        "on, or was made with record.inputs false or by an older kadans");
  if (of_robot && !InputLayout::of(layout->second))
    refuse(record, "holds inputs that this kadans cannot read: they were recorded by kadans " + inputs.fact("kadans"));
  if (inputs.empty())
    refuse(record, "does not hold what it was made of: it was recorded by kadans " + inputs.fact("kadans") +
                       " or ends too early");
  return inputs;
}

PluginGate plugins_beside(const fs::path& scenario, bool any_plugins) {
  if (any_plugins || lies_in_project_here(scenario)) return {};
  return {.closed = true,
          .let_in = {},
          .remedy = "its project is not the one around the working directory; --allow-plugins loads what lies there"};
}

bool is_flight_record(const std::string& record) {
  McapReader reader(record);
  McapMessage message;
  (void)reader.next(message);
  const auto found = reader.metadata().find(inputs_metadata);
  const auto layout = found == reader.metadata().end() ? std::nullopt : InputLayout::of(found->second);
  return layout && layout->state_bytes > 0;
}

UnpackedInputs::UnpackedInputs(const RunInputs& recorded, const std::string& record, bool any_plugins,
                               const std::vector<std::string>& with)
    : owner_(getpid()) {
  std::string pattern = (fs::temp_directory_path() / "kadans-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) refuse(pattern, "no temporary folder can be made there");
  folder_ = fs::absolute(pattern).lexically_normal();
  plugins_ = {.closed = true,
              .let_in = {},
              .remedy =
                  "native code does not come out of a record. Put it into the project around the working directory, "
                  "in the place that the record knows"};
  try {
    for (const char* name : {"config", "models", "behaviors", beside}) fs::create_directories(folder_ / name);
    std::map<std::string, std::string> given;
    for (const std::string& file : with) given[name_in_project(file)] = file;
    for (const InputFile& file : recorded.files) {
      const bool plugin = !file.text && !file.hash.empty() && !file.left_out;
      if (plugin) link_plugin(file, record, any_plugins);
      if (plugin || fs::path(file.path).is_absolute() || given.contains(file.path)) continue;
      file.left_out ? fetch(file, record) : unpack(file);
    }
    for (const auto& [name, file] : given) {
      std::error_code error;
      fs::remove(folder_ / name, error);  // also a plug-in's link
      replace({name, "", read_input_file(fs::absolute(file), input_max_bytes)});
    }
    for (const auto& [name, file] : given) given_.insert(name);
    const std::string name = recorded.fact("scenario_input");
    const auto scenario = std::ranges::find(recorded.files, name, &InputFile::path);
    if (scenario == recorded.files.end() || !(scenario->text || scenario->left_out) || fs::path(name).is_absolute())
      refuse(record, "does not hold its scenario");
    scenario_ = folder_ / name;
  } catch (const fs::filesystem_error& error) {  // a name is too long, or a file stands in the place of a folder
    remove();
    refuse(record, std::string("its files cannot be unpacked: ") + error.what());
  } catch (...) {
    remove();
    throw;
  }
}

void UnpackedInputs::remove() const noexcept {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

UnpackedInputs::~UnpackedInputs() {
  if (getpid() == owner_) remove();
}

void UnpackedInputs::add_behaviors(RunInputs& inputs) const {
  const fs::path root = project_here();
  if (!fs::is_directory(root / "behaviors")) return;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "behaviors")) {
    if (entry.path().extension() == ".lua" && !entry.path().stem().string().ends_with("_test"))
      files.push_back(entry.path().lexically_relative(root));
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    if (fs::exists(folder_ / file)) continue;
    std::string text = read_all(root / file).value_or("");
    std::string hash = content_hash(text);
    inputs.files.push_back({file.generic_string(), std::move(hash), std::move(text)});
    unpack(inputs.files.back());
  }
  std::ranges::sort(inputs.files, {}, &InputFile::path);
}

void UnpackedInputs::link_plugin(const InputFile& file, const std::string& record, bool any_plugins) {
  const fs::path here = project_here() / file.path;  // an absolute path stays unchanged
  const auto lacks = [&](const std::string& why) { refuse(record, "needs the plug-in " + file.path + ", " + why); };
  // If the recorded hash alone decided, the sender of a record could choose any file of this machine, also files that
  // came with the record.
  const std::string inside = here.lexically_normal().lexically_relative(project_here()).generic_string();
  if (!any_plugins && (inside.empty() || inside.starts_with("..")))
    lacks("which is not in the project around the working directory: --allow-plugins takes it from there");
  const std::optional<std::string> now = read_all(here);
  if (!now) lacks("which is not " + std::string(here == file.path ? "there" : "in this project"));
  if (!any_plugins && content_hash(*now) != file.hash)
    lacks("and the one here is another: build it as it was, or take this one with --allow-plugins");
  if (!any_plugins && !is_own(here))
    lacks("which belongs to another user: give it to yourself, or take it with --allow-plugins");
  if (here == file.path) return plugins_.let_in.push_back(here);
  fs::create_directories((folder_ / file.path).parent_path());
  fs::create_symlink(here, folder_ / file.path);  // fails when the file exists
  plugins_.let_in.push_back(folder_ / file.path);
}

void UnpackedInputs::replace(const InputFile& file) const {
  const fs::path name = fs::path(file.path).lexically_normal(), place = folder_ / name;
  if (name.empty() || name.is_absolute() || *name.begin() == "..") refuse(file.path, "leads out of the record's files");
  if (given_.contains(name.generic_string())) return;
  try {
    if (fs::is_symlink(fs::symlink_status(place)))
      refuse(file.path, "is a plug-in, and native code does not come out of a record");
    if (fs::is_regular_file(place)) fs::remove(place);
    unpack(file);
  } catch (const fs::filesystem_error& error) {
    refuse(file.path, std::string("cannot be unpacked: ") + error.what());
  }
}

void UnpackedInputs::fetch(const InputFile& file, const std::string& record) const {
  const std::optional<std::string> here = read_all(project_here() / file.path);
  const auto lacks = [&](const std::string& why) {
    refuse(record, "needs " + file.path + ", a private file that it does not hold, " + why);
  };
  if (!here) lacks("and it is not in the project around the working directory");
  if (content_hash(*here) != file.hash)
    lacks("and the one in this project is another: its hash is " + content_hash(*here) + ", recorded was " + file.hash);
  replace({file.path, file.hash, here});
}

void UnpackedInputs::unpack(const InputFile& file) const {
  const fs::path place = folder_ / file.path;
  fs::create_directories(place.parent_path());
  if (fs::exists(fs::symlink_status(place))) refuse(place, "is there already");
  std::ofstream stream(place, std::ios::binary);
  stream << file.text.value_or("");  // a mesh stays empty: only its name is used
  stream.close();
  if (!stream) refuse(place, "cannot be written");
}

}  // namespace kadans
