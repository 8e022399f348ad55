#include "generated_code.h"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string_view>

#include <tinyxml2.h>

#include "kadans/signal/input_error.h"
#include "model/urdf/urdf_description.h"
#include "model/xml_scan.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t code_files_max = 500, code_values_max = 1000;

struct CodeFile {
  fs::path path;
  std::string text;
  std::string bare{};  // of C, without comments

  bool is_xml() const { return path.extension() == ".xml"; }
};

std::string without_comments(const std::string& text) {
  std::string bare;
  for (std::size_t i = 0; i < text.size();) {
    if (text.compare(i, 2, "/*") == 0) {
      const std::size_t end = text.find("*/", i + 2);
      bare += ' ';
      i = end == std::string::npos ? text.size() : end + 2;
    } else if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
    } else {
      bare += text[i++];
    }
  }
  return bare;
}

// Patterns look at lines of C: what is longer than any tool writes is refused.
void refuse_long_lines(const CodeFile& file) {
  constexpr std::size_t line_max = 8000;
  for (std::size_t at = 0; at < file.text.size();) {
    const std::size_t end = std::min(file.text.find('\n', at), file.text.size());
    if (end - at > line_max) refuse(file.path, "has a line of more than " + std::to_string(line_max) + " characters");
    at = end + 1;
  }
}

std::vector<CodeFile> code_files(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) refuse(folder, "is no folder");
  std::vector<CodeFile> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string ending = entry.path().extension().string();
    if (!entry.is_regular_file() || (ending != ".c" && ending != ".h" && ending != ".xml")) continue;
    if (files.size() == code_files_max)
      refuse(folder,
             "holds more than " + std::to_string(code_files_max) + " files of C: name the folder of one model's code");
    CodeFile file{.path = entry.path(), .text = read_input_file(entry.path().string())};
    if (!file.is_xml()) {
      refuse_long_lines(file);
      file.bare = without_comments(file.text);
    }
    files.push_back(std::move(file));
  }
  std::ranges::sort(files, {}, &CodeFile::path);
  return files;
}

// "controller\\kp" and "u[1]" become "controller.kp" and "u_1".
std::string plain_name(const std::string& written) {
  std::string name;
  for (const char c : written) {
    const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    const char as = word ? c : c == '\\' || c == '.' ? '.' : '_';
    if (as == ']' || (!word && (name.empty() || name.back() == '_' || name.back() == '.'))) continue;
    name += as;
  }
  while (!name.empty() && (name.back() == '_' || name.back() == '.')) name.pop_back();
  return name;
}

void add_value(std::vector<CodeValue>& values, CodeValue value, const fs::path& file) {
  value.name = plain_name(value.name);
  if (value.name.empty()) refuse(file, "has a name in its tables that is empty");
  if (values.size() == code_values_max) refuse(file, "has more than " + std::to_string(code_values_max) + " values");
  for (int i = 2; std::ranges::any_of(values, [&](const CodeValue& other) { return other.name == value.name; }); ++i)
    value.name = plain_name(value.name) + "_" + std::to_string(i);
  values.push_back(std::move(value));
}

std::string list_of(const std::vector<CodeFile>& files) {
  std::string names;
  std::size_t told = 0;
  for (const CodeFile& file : files) {
    if (++told > 8) return names + " and " + std::to_string(files.size() - 8) + " more";
    names += (names.empty() ? "" : ", ") + file.path.filename().string();
  }
  return names.empty() ? "no file of C" : names;
}

std::smatch first_match(const std::string& text, const char* pattern) {
  std::smatch match;
  std::regex_search(text, match, std::regex(pattern));
  return match;
}

// What is compiled: neither a main program, nor what another source includes.
void take_files(const std::vector<CodeFile>& files, GeneratedCode& code) {
  std::set<std::string> included;
  for (const CodeFile& file : files) {
    static const std::regex include(R"re(#\s*include\s*"([^"]*\.c)")re");
    for (std::sregex_iterator i(file.bare.begin(), file.bare.end(), include), end; i != end; ++i)
      included.insert(fs::path((*i)[1].str()).filename().string());
  }
  for (const CodeFile& file : files) {
    const bool source = file.path.extension() == ".c";
    const bool program = source && std::regex_search(file.bare, std::regex(R"(\bmain\s*\()"));
    if (program) continue;
    (source && !included.contains(file.path.filename().string()) ? code.sources : code.others).push_back(file.path);
  }
}

// 20-sim. Names stand in tables, which may be commented out, or beside the elements of u and y.
void read_name_table(const std::vector<CodeFile>& files, const std::string& table, const std::string& array,
                     std::vector<CodeValue>& values) {
  for (const CodeFile& file : files) {
    if (file.is_xml()) continue;
    const std::smatch found =
        first_match(file.text, ("\\b(\\w*)_" + table + R"(_names\s*\[[^\]\n]*\]\s*=\s*\{)").c_str());
    if (found.empty()) continue;
    const auto open = static_cast<std::size_t>(found.position() + found.length());
    const std::string body = file.text.substr(open, file.text.find('}', open) - open), before = found[1];
    static const std::regex text(R"re("((?:[^"\\]|\\.)*)")re");
    std::size_t index = 0;
    for (std::sregex_iterator i(body.begin(), body.end(), text), end; i != end; ++i, ++index) {
      const std::string at = "[" + std::to_string(index) + "]";
      add_value(values, {.name = (*i)[1], .access = (array == "P" ? before + "_P" : array) + at}, file.path);
    }
    return;
  }
}

void read_element_comments(const std::vector<CodeFile>& files, const std::string& array,
                           std::vector<CodeValue>& values) {
  std::map<int, std::pair<std::string, fs::path>> names;
  const std::regex pattern("\\b" + array + R"(\s*\[\s*(\d{1,4})\s*\][^;\n]*;[ \t]*/\*\s*([^*\n]+?)\s*\*/)");
  for (const CodeFile& file : files) {
    if (file.is_xml()) continue;
    for (std::sregex_iterator i(file.text.begin(), file.text.end(), pattern), end; i != end; ++i)
      names.try_emplace(std::stoi((*i)[1]), (*i)[2], file.path);
  }
  int next = 0;
  for (const auto& [index, name] : names) {
    if (index != next++)
      refuse(name.second, "names " + array + "[" + std::to_string(index) + "] in a comment, but not " + array + "[" +
                              std::to_string(next - 1) + "]: looked for all of them, such as `" + array +
                              "[0] = 0.0; /* name */`");
    add_value(values, {.name = name.first, .access = array + "[" + std::to_string(index) + "]"}, name.second);
  }
}

GeneratedCode read_twenty_sim(const std::vector<CodeFile>& files, const CodeFile& header) {
  GeneratedCode code{.shape = GeneratedCode::Shape::twenty_sim, .tool = "20-sim", .header = header.path.filename()};
  const std::smatch begins = first_match(header.bare, R"(\b(\w*)InitializeSubmodel(\w*)\s*\()");
  code.before = begins[1];
  code.behind = begins[2];
  for (const char* word : {"Initialize", "Calculate", "Terminate"}) {
    const std::string wanted = code.before + word + "Submodel" + code.behind;
    const std::regex with_arrays("\\b" + wanted +
                                 R"(\s*\(\s*\w+\s*\*\s*\w+\s*,\s*\w+\s*\*\s*\w+\s*,\s*\w+\s+\w+\s*\))");
    if (std::regex_search(header.bare, with_arrays)) continue;
    const std::smatch other = first_match(header.bare, ("\\b" + wanted + R"(\s*\([^)]*\))").c_str());
    refuse(header.path, "looked for " + wanted + " (XXDouble *u, XXDouble *y, XXDouble t), found " +
                            (other.empty() ? std::string("none") : other[0].str()));
  }
  read_name_table(files, "input", "u", code.inputs);
  read_name_table(files, "output", "y", code.outputs);
  read_name_table(files, "parameter", "P", code.parameters);
  if (code.inputs.empty()) read_element_comments(files, "u", code.inputs);
  if (code.outputs.empty()) read_element_comments(files, "y", code.outputs);
  if (code.inputs.empty() || code.outputs.empty())
    refuse(header.path.parent_path(),
           std::string("looked for the names of its ") +
               (code.inputs.empty() ? "inputs: a table xx_input_names, or `u[0] = 0.0; /* name */`"
                                    : "outputs: a table xx_output_names, or `y[0] = 0.0; /* name */`") +
               "; found neither in " + list_of(files));
  for (const CodeFile& file : files) {
    const std::smatch step = first_match(file.bare, R"(_step_size\s*=\s*([0-9.]+(?:[eE][-+]?\d+)?))");
    if (!step.empty()) code.step_s = std::stod(step[1]);
  }
  return code;
}

// Between the braces of `typedef struct {...} TYPE;` or `struct TYPE_ {...};`; "" where there is none.
std::string struct_body(const std::string& text, const std::string& type) {
  const std::smatch end = first_match(text, (R"(\}\s*)" + type + R"(\s*;)").c_str());
  if (!end.empty()) {
    const auto close = static_cast<std::size_t>(end.position());
    const std::size_t open = text.rfind('{', close);
    return open == std::string::npos ? "" : text.substr(open + 1, close - open - 1);
  }
  const std::smatch begin = first_match(text, ("\\bstruct\\s+" + type + R"(_?\s*\{)").c_str());
  if (begin.empty()) return "";
  const auto open = static_cast<std::size_t>(begin.position() + begin.length());
  const std::size_t close = text.find('}', open);
  return close == std::string::npos ? "" : text.substr(open, close - open);
}

// Simulink Coder. The fields of a struct whose variable is MODEL_U.
void read_struct(const std::vector<CodeFile>& files, const std::string& variable, std::vector<CodeValue>& values) {
  static const std::set<std::string> scalars{"real_T",  "real32_T",  "real64_T", "int8_T",   "uint8_T",
                                             "int16_T", "uint16_T",  "int32_T",  "uint32_T", "int_T",
                                             "uint_T",  "boolean_T", "double",   "float"};
  for (const CodeFile& file : files) {
    const std::smatch declared = first_match(file.bare, ("\\bextern\\s+(\\w+)\\s+" + variable + "\\s*;").c_str());
    if (declared.empty()) continue;
    const std::string type = declared[1];
    for (const CodeFile& other : files) {
      const std::string fields = struct_body(other.bare, type);
      if (fields.empty()) continue;
      static const std::regex field(R"((\w+)\s+(\w+)\s*(?:\[\s*(\d{1,4})\s*\])?\s*;)");
      for (std::sregex_iterator i(fields.begin(), fields.end(), field), end; i != end; ++i) {
        const std::string name = (*i)[2];
        if (!scalars.contains((*i)[1]))
          refuse(other.path, "looked for numbers in " + type + ", found the field " + name + " of the type " +
                                 (*i)[1].str() + ": let the model have no buses there");
        const int count = (*i)[3].matched ? std::stoi((*i)[3]) : 0;
        if (count == 0) add_value(values, {.name = name, .access = variable + "." + name}, other.path);
        for (int at = 0; at < count; ++at) {
          const std::string index = std::to_string(at);
          add_value(values, {.name = name + "_" + index, .access = variable + "." + name + "[" + index + "]"},
                    other.path);
        }
      }
      return;
    }
    refuse(file.path, "declares " + variable + " of the type " + type + ": looked for its struct, found none in " +
                          list_of(files));
  }
}

GeneratedCode read_simulink(const std::vector<CodeFile>& files, const CodeFile& header, const std::string& model) {
  GeneratedCode code{.shape = GeneratedCode::Shape::simulink,
                     .tool = "Simulink Coder",
                     .header = header.path.filename(),
                     .before = model};
  for (const char* word : {"_initialize", "_step", "_terminate"}) {
    const std::string wanted = model + word;
    if (std::regex_search(header.bare, std::regex("\\b" + wanted + R"(\s*\(\s*(?:void)?\s*\))"))) continue;
    const std::smatch other = first_match(header.bare, ("\\b" + wanted + R"(\s*\([^)]*\))").c_str());
    refuse(header.path, "looked for " + wanted + "(void), found " +
                            (other.empty() ? std::string("none") : other[0].str()) +
                            ": generate it with nonreusable code and a single step function");
  }
  read_struct(files, model + "_U", code.inputs);
  read_struct(files, model + "_Y", code.outputs);
  read_struct(files, model + "_P", code.parameters);
  if (code.inputs.empty() || code.outputs.empty())
    refuse(header.path, "looked for `extern ExtU_" + model + "_T " + model +
                            "_U;` and ..._Y with their structs, found no " +
                            (code.inputs.empty() ? "inputs" : "outputs"));
  for (const CodeFile& file : files) {
    std::smatch step = first_match(file.bare, R"(stepSize0\s*=\s*([0-9.]+(?:[eE][-+]?\d+)?))");
    if (step.empty() && !file.is_xml()) step = first_match(file.text, R"(Sample time: \[([0-9.]+(?:[eE][-+]?\d+)?)s)");
    if (!step.empty() && code.step_s == 0) code.step_s = std::stod(step[1]);
  }
  return code;
}

using tinyxml2::XMLElement;

// "" without it.
std::string attribute(const XMLElement& element, const char* name) {
  const char* const value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

// nullptr where there is no element to begin with, too.
const XMLElement* child(const XMLElement* element, const char* name) {
  return element == nullptr ? nullptr : element->FirstChildElement(name);
}

GeneratedCode read_fmu(const std::vector<CodeFile>& files, const CodeFile& description) {
  GeneratedCode code{.shape = GeneratedCode::Shape::fmu, .tool = "OpenModelica (FMI 2.0)"};
  if (description.text.size() > description_max_bytes)
    refuse(description.path, "has more than " + std::to_string(description_max_bytes) + " bytes");
  if (const auto wrong = find_non_text(description.text)) refuse(description.path, "is no XML: " + wrong->message);
  tinyxml2::XMLDocument xml;
  if (xml.Parse(description.text.data(), description.text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({.file = description.path.string(),
                      .line = xml.ErrorLineNum(),
                      .message = std::string("not well-formed XML: ") + xml.ErrorName()});
  const XMLElement* const head = xml.FirstChildElement("fmiModelDescription");
  if (head == nullptr || attribute(*head, "fmiVersion") != "2.0")
    refuse(description.path,
           "looked for fmiVersion=\"2.0\", found " +
               (head == nullptr ? "no fmiModelDescription" : "\"" + attribute(*head, "fmiVersion") + "\""));
  const XMLElement* const part = child(head, "CoSimulation");
  if (part == nullptr)
    refuse(
        description.path,
        "looked for <CoSimulation modelIdentifier=...>, found none: let the FMU be of co-simulation (fmuType=\"cs\")");
  code.guid = attribute(*head, "guid");
  const std::string identifier = attribute(*part, "modelIdentifier");
  bool source = false;
  for (const CodeFile& file : files) {  // a name that stands in the text, or one that a macro puts the prefix before
    const std::smatch found = first_match(file.bare, R"(\b(\w*)fmi2DoStep\s*[()])");
    if (found.empty() || file.path.extension() != ".c") continue;
    source = true;
    code.before = found[1];
  }
  for (const CodeFile& file : files) {
    const std::smatch prefix = first_match(file.bare, R"(#\s*define\s+FMI2_FUNCTION_PREFIX\s+(\w+))");
    if (!prefix.empty() && code.before.empty()) code.before = prefix[1];
  }
  if (!source)
    refuse(description.path, "looked for fmi2DoStep in sources of C beside it, found none in " + list_of(files) +
                                 ": let the FMU of " + identifier + " have its sources");
  const char* const variable = "ScalarVariable";
  for (const XMLElement* of = child(child(head, "ModelVariables"), variable); of != nullptr;
       of = of->NextSiblingElement(variable)) {
    const XMLElement* const real = child(of, "Real");
    const std::string causality = attribute(*of, "causality"), number = attribute(*of, "valueReference");
    std::vector<CodeValue>* const values = causality == "input"       ? &code.inputs
                                           : causality == "output"    ? &code.outputs
                                           : causality == "parameter" ? &code.parameters
                                                                      : nullptr;
    if (values == nullptr || (causality == "parameter" && attribute(*of, "variability") == "fixed")) continue;
    if (real == nullptr) {
      if (causality == "parameter") continue;
      refuse(description.path,
             "looked for Real " + causality + "s, found '" + attribute(*of, "name") + "' of another type");
    }
    if (!std::regex_match(number, std::regex(R"(\d{1,9})")))
      refuse(description.path, "'" + attribute(*of, "name") + "' has no valueReference");
    add_value(*values,
              {.name = attribute(*of, "name"),
               .access = number,
               .unit = attribute(*real, "unit"),
               .doc = attribute(*of, "description")},
              description.path);
  }
  if (code.inputs.empty() || code.outputs.empty())
    refuse(description.path, "looked for ScalarVariables with causality=\"input\" and \"output\", found no " +
                                 std::string(code.inputs.empty() ? "inputs" : "outputs"));
  return code;
}

}  // namespace

GeneratedCode read_generated_code(const fs::path& folder) {
  const std::vector<CodeFile> files = code_files(folder);
  std::optional<GeneratedCode> code;
  for (const CodeFile& file : files) {
    if (file.path.filename() == "modelDescription.xml") code = read_fmu(files, file);
  }
  for (const CodeFile& file : files) {
    if (code || file.path.extension() != ".h") continue;
    if (std::regex_search(file.bare, std::regex(R"(\b\w*InitializeSubmodel\w*\s*\()")))
      code = read_twenty_sim(files, file);
  }
  for (const CodeFile& file : files) {
    if (code || file.path.extension() != ".h") continue;
    const std::smatch step = first_match(file.bare, R"(\bextern\s+void\s+(\w+)_step\s*\()");
    if (!step.empty()) code = read_simulink(files, file, step[1]);
  }
  if (!code)
    refuse(folder,
           "is no code that is known: looked for XXInitializeSubmodel in a header (20-sim), `extern void "
           "MODEL_step(void);` in a header (Simulink Coder), and modelDescription.xml with sources "
           "(OpenModelica, FMI 2.0); found " +
               list_of(files));
  take_files(files, *code);
  if (code->sources.empty()) refuse(folder, "looked for sources of C to compile, found " + list_of(files));
  return *code;
}

}  // namespace kadans
