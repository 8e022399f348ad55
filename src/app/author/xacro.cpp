#include "xacro.h"

#include <system_error>

#include "kadans/signal/input_error.h"
#include "realtime/machine/child_process.h"
#include "signal/input_file.h"
#include "signal/shell_word.h"

namespace kadans {

std::string expanded_xacro(const std::filesystem::path& file) {
  check_input_file(file);
  const auto fail = [&](const std::string& message) { throw InputError({.file = file.string(), .message = message}); };
  ProgramOutput output;
  try {
    output = run_program({"xacro", std::filesystem::absolute(file).string()});
  } catch (const std::system_error&) {
    const std::string name = shell_word(file.string());
    const std::string urdf = shell_word(std::filesystem::path(file).replace_extension().replace_extension(".urdf"));
    fail("is xacro, which the program xacro expands, and that is not installed here: where ROS is, 'xacro " + name +
         " > " + urdf + "'; elsewhere 'pip install xacro' brings it");
  }
  if (output.exit_code != 0) {
    const std::size_t end = output.err.find_last_not_of("\r\n");
    const std::string said = end == std::string::npos ? "nothing" : output.err.substr(0, end + 1);
    fail("xacro could not expand it, and says:\n" + said);
  }
  return output.out;
}

}  // namespace kadans
