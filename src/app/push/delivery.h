// What `kadans push` brings to a robot's computer: the files of one robot and of its behaviors.
//
// It travels as an MCAP file without messages, in the form in which records hold the files of a run
// (telemetry/record/run_inputs.h): compressed, each with its hash, and no path leads out of the project.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "signal/owned_descriptor.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {

struct Delivery {
  std::string robot;             // path of its robot.json from the project's root
  std::string name;              // of the robot
  std::vector<InputFile> files;  // by path, all with their content

  // The same for the same files, on every machine.
  std::string hash() const;
};

// The robot's configuration with its bases, its URDF with the meshes, and all behaviors and modules of its project but
// their tests. Native code is not among them: a plug-in must lie on the robot's computer, where it was built for that.
// Throws InputError for a file outside of the project, for a plug-in inside of it, and for too much.
Delivery gather_delivery(const std::filesystem::path& robot);

// Throw InputError. What is read was checked: every file is whole, lies in config, models or behaviors, and the robot
// is one of them.
void write_delivery(const Delivery& delivery, const std::filesystem::path& file);
Delivery read_delivery(const std::filesystem::path& file);

// A folder on the robot's computer that holds the newest delivery as a project, whole at each moment: a delivery is
// written and forced to the disk beside it, in FOLDER.next, and then the two folders change places. The one before it
// is kept in FOLDER.before. FOLDER/run.conf tells the service kadans@ROBOT which configuration to take.
//
// One process at a time: FOLDER.lock is held as long as the object lives.
class DeliveryFolder {
 public:
  // Makes the folder around it. Throws InputError when it cannot be written, or when another push is under way.
  explicit DeliveryFolder(const std::filesystem::path& folder);
  ~DeliveryFolder();
  DeliveryFolder(const DeliveryFolder&) = delete;
  DeliveryFolder& operator=(const DeliveryFolder&) = delete;

  const std::filesystem::path& folder() const noexcept { return folder_; }
  // Where a delivery is laid out before it counts.
  std::filesystem::path next() const { return beside(".next"); }
  // A place for the file that comes in; removed with this object.
  std::filesystem::path incoming() const { return beside(".incoming"); }

  // Throws InputError when the disk does not take it; then nothing has changed.
  void lay_out(const Delivery& delivery);
  // The laid out one counts from now on, and the present one is the one before it. Throws InputError.
  void take_next();
  // What take_next() did was refused: the two folders are again what they were before it. Throws InputError.
  void take_back();
  void forget_older() noexcept;  // it was not
  // The one before counts again; the present one becomes the one before. Throws InputError when there is none.
  void undo();

  // Files that differ between the present delivery and the one in `other`, each with how: "changed", "is new", "is
  // gone".
  struct Change {
    std::string path, how;
  };
  std::vector<Change> changes_to(const std::filesystem::path& other) const;

 private:
  std::filesystem::path beside(const char* suffix) const { return folder_.string() + suffix; }
  void trade(const std::filesystem::path& other) const;

  std::filesystem::path folder_;
  OwnedDescriptor lock_;
};

}  // namespace kadans
