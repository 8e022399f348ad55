#include "delivery.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "app/sim/input_files.h"
#include "config/robot/project_root.h"
#include "config/robot/robot_config.h"
#include "config/scenario/based_on.h"
#include "kadans/signal/content_hash.h"
#include "kadans/signal/shell_word.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/mcap/mcap_writer.h"
#include "version.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> project_folders{"config", "models", "behaviors"};
constexpr std::size_t delivery_max_bytes = std::size_t{64} << 20U;  // as for the files in a record

[[noreturn]] void fail_there(const fs::path& file, const char* what) {
  refuse(file, what + (": " + std::generic_category().message(errno)));
}

bool lies_in_project_folder(const std::string& path) {
  return std::ranges::any_of(project_folders, [&](std::string_view folder) {
    return path.size() > folder.size() + 1 && path.starts_with(folder) && path[folder.size()] == '/';
  });
}

// The files of one project by their paths in it.
class Collection {
 public:
  explicit Collection(const fs::path& root) : root_(root) {}

  void add(const fs::path& file) {
    const std::string path = fs::absolute(file).lexically_normal().lexically_relative(root_).generic_string();
    if (!lies_in_project_folder(path))
      refuse(file, "lies outside of config, models and behaviors of " + root_.string() + ", and cannot be pushed");
    if (files_.contains(path)) return;
    std::string text = read_input_file(file, delivery_max_bytes);
    bytes_ += text.size();
    if (bytes_ > delivery_max_bytes)
      refuse(file, "with this one the files have more than " + std::to_string(delivery_max_bytes >> 20U) +
                       " MiB, too much for a push");
    std::string hash = content_hash(text);
    files_.emplace(path, InputFile{path, std::move(hash), std::move(text)});
  }

  std::vector<InputFile> take() {
    std::vector<InputFile> all;
    for (auto& [path, file] : files_) all.push_back(std::move(file));
    return all;
  }

 private:
  fs::path root_;
  std::map<std::string, InputFile> files_;
  std::size_t bytes_ = 0;
};

void sync_folder(const fs::path& folder) {
  const OwnedDescriptor descriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!descriptor) fail_there(folder, "cannot be opened");
  if (fsync(descriptor.number()) != 0) fail_there(folder, "cannot be forced to the disk");
}

// The hashes of all files in a folder, by path.
std::map<std::string, std::string> hashes_in(const fs::path& folder) {
  std::map<std::string, std::string> hashes;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    if (!i->is_regular_file(error)) continue;
    const std::string path = i->path().lexically_relative(folder).generic_string();
    if (lies_in_project_folder(path)) hashes[path] = content_hash(read_input_file(i->path(), delivery_max_bytes));
  }
  return hashes;
}

}  // namespace

std::string Delivery::hash() const {
  ContentHash all;
  all.add(robot);
  for (const InputFile& file : files) {
    all.add(file.path);
    all.add(file.hash);
  }
  return all.hex();
}

Delivery gather_delivery(const fs::path& robot_file) {
  const fs::path file = fs::absolute(robot_file).lexically_normal(), root = project_root(file);
  const RobotConfig robot = read_robot_config(file, {});  // its plug-ins may be there alone
  Collection files(root);
  for (const fs::path& part : files_of(file)) files.add(part);
  for (const PluginFile& plugin : read_plugin_files(file)) {
    if (!fs::path(plugin.file).lexically_relative(root).generic_string().starts_with(".."))
      refuse(plugin.file,
             "is native code, which is not pushed: build it on the robot's computer, outside of the project, and "
             "name it by its absolute path");
  }
  files.add(robot.model.file);
  for (const fs::path& mesh : mesh_files(robot.model)) files.add(mesh);
  std::error_code none;
  for (fs::recursive_directory_iterator i(root / "behaviors", none), end; !none && i != end; i.increment(none)) {
    const fs::path& path = i->path();
    if (path.extension() == ".lua" && !path.stem().string().ends_with("_test")) files.add(path);
  }
  return {.robot = file.lexically_relative(root).generic_string(), .name = robot.name, .files = files.take()};
}

void write_delivery(const Delivery& delivery, const fs::path& file) {
  McapWriter writer;
  const RunInputs inputs{.run = {{"robot", delivery.robot}, {"name", delivery.name}, {"kadans", version}},
                         .program = {},
                         .files = delivery.files};
  if (!writer.open(file.string()) || !write_inputs(writer, inputs) || !writer.close()) refuse(writer.error());
}

Delivery read_delivery(const fs::path& file) {
  McapReader reader(file.string());
  for (McapMessage message; reader.next(message);) {
  }
  if (!reader.complete()) refuse(file, "came incomplete: " + reader.problem());
  RunInputs inputs = read_inputs(reader, file.string());
  Delivery delivery{.robot = inputs.fact("robot"), .name = inputs.fact("name"), .files = std::move(inputs.files)};
  for (const InputFile& part : delivery.files) {
    if (!part.text) refuse(file, "lacks " + part.path);
    if (!lies_in_project_folder(part.path))
      refuse(file, "holds " + part.path + ", which is neither in config, models nor behaviors");
  }
  if (std::ranges::find(delivery.files, delivery.robot, &InputFile::path) == delivery.files.end())
    refuse(file, "does not hold the configuration of a robot");
  return delivery;
}

DeliveryFolder::DeliveryFolder(const fs::path& folder) : folder_(fs::absolute(folder).lexically_normal()) {
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  if (folder_ == folder_.root_path()) refuse(folder, "is no folder for a robot");
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  if (error) refuse(folder_.parent_path(), "cannot be made: " + error.message());
  const fs::path lock = beside(".lock");
  lock_ = OwnedDescriptor(open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (!lock_) fail_there(lock, "cannot be opened");
  if (flock(lock_.number(), LOCK_EX | LOCK_NB) != 0) refuse(folder_, "another push is under way");
}

DeliveryFolder::~DeliveryFolder() {
  std::error_code ignored;
  fs::remove(incoming(), ignored);
  fs::remove_all(next(), ignored);
}

void DeliveryFolder::lay_out(const Delivery& delivery) {
  try {
    fs::remove_all(next());
    for (const std::string_view name : project_folders) fs::create_directories(next() / name);
    std::set<fs::path> folders{next()};
    for (const InputFile& file : delivery.files) {
      const fs::path place = next() / file.path;
      fs::create_directories(place.parent_path());
      write_durably(place, file.text.value_or(""));
      for (fs::path at = place.parent_path(); at != next(); at = at.parent_path()) folders.insert(at);
    }
    write_durably(next() / "run.conf",
                  "# Written by kadans push.\nKADANS_ROBOT=" + shell_word((folder_ / delivery.robot).string()) + "\n");
    for (const fs::path& folder : folders) sync_folder(folder);
  } catch (const fs::filesystem_error& error) {
    refuse(next(), std::string("cannot be written: ") + error.what());
  }
}

// The two folders change places at once.
void DeliveryFolder::trade(const fs::path& other) const {
  if (renameat2(AT_FDCWD, other.c_str(), AT_FDCWD, folder_.c_str(), RENAME_EXCHANGE) != 0)
    fail_there(folder_, "cannot be exchanged");
  sync_folder(folder_.parent_path());
}

void DeliveryFolder::take_next() {
  std::error_code error;
  if (!fs::exists(folder_)) {
    fs::rename(next(), folder_, error);
    if (error) refuse(folder_, "cannot be made: " + error.message());
    return sync_folder(folder_.parent_path());
  }
  trade(next());
  fs::remove_all(beside(".older"), error);
  fs::rename(beside(".before"), beside(".older"), error);  // there may be none
  fs::rename(next(), beside(".before"), error);
  if (error) refuse(beside(".before"), "cannot be kept: " + error.message());
  sync_folder(folder_.parent_path());
}

void DeliveryFolder::undo() {
  if (!fs::exists(beside(".before"))) refuse(folder_, "there is nothing before what is there");
  trade(beside(".before"));
}

void DeliveryFolder::take_back() {
  undo();
  std::error_code error;
  fs::remove_all(beside(".before"), error);
  fs::rename(beside(".older"), beside(".before"), error);  // there may be none
  sync_folder(folder_.parent_path());
}

void DeliveryFolder::forget_older() noexcept {
  std::error_code error;
  fs::remove_all(beside(".older"), error);
}

std::vector<DeliveryFolder::Change> DeliveryFolder::changes_to(const fs::path& other) const {
  const std::map<std::string, std::string> now = hashes_in(folder_), then = hashes_in(other);
  std::vector<Change> changes;
  for (const auto& [path, hash] : then) {
    const auto found = now.find(path);
    if (found == now.end()) changes.push_back({path, "is new"});
    if (found != now.end() && found->second != hash) changes.push_back({path, "changed"});
  }
  for (const auto& [path, hash] : now) {
    if (!then.contains(path)) changes.push_back({path, "is gone"});
  }
  return changes;
}

}  // namespace kadans
