#include "record_meshes.h"

#include <filesystem>
#include <memory>
#include <system_error>

#include "config/robot/project_root.h"
#include "signal/input_file.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/run_inputs.h"

namespace kadans {
namespace fs = std::filesystem;

std::function<LiveAssets::Content(std::string_view)> meshes_of_record(const std::string& record) {
  McapReader reader(record);
  McapMessage first;
  (void)reader.next(first);  // what comes before it is read now
  const RunInputs inputs = read_inputs(reader, record);
  RobotTexts texts;
  std::string urdf_file;
  for (const InputFile& input : inputs.files) {
    if (!input.text || !(input.path.ends_with(".urdf") || input.path.ends_with(".URDF"))) continue;
    for (const fs::path& near : {fs::path(inputs.fact("scenario")), fs::current_path() / "x", fs::absolute(record)}) {
      const fs::path file = project_root(near) / input.path;
      std::error_code error;
      if (!fs::is_regular_file(file, error) || content_hash(read_input_file(file.string())) != input.hash) continue;
      if (urdf_file.empty()) {
        texts.urdf = *input.text;
        urdf_file = file.string();
      } else {
        texts.others.push_back({.name = "", .urdf = *input.text, .file = file.string()});
      }
      break;
    }
  }
  const auto meshes = urdf_file.empty() ? nullptr : std::make_shared<LiveAssets>(texts, urdf_file);
  return [meshes](std::string_view name) { return meshes ? meshes->read(name) : nullptr; };
}

}  // namespace kadans
