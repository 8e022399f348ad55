#include "ctl_print.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace kadans {
namespace {

constexpr std::size_t column_max = 48;

std::string number(const Json& value) {
  if (!value.is_number()) return "nan";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value.get<double>());
  return text;
}

std::string joined(const Json& texts) {
  std::string all;
  for (const Json& text : texts) all += (all.empty() ? "" : ", ") + text.get<std::string>();
  return all;
}

// Rows of cells, each column as wide as its widest.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      widths[i] = std::max(widths[i], std::min(row[i].size(), column_max));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line.append(std::max(row[i].size(), widths[i]) - row[i].size() + 2, ' ');
    }
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string behavior_text(const Json& behavior) {
  const std::string name = behavior.at("name");
  if (behavior.contains("error")) return name + ": " + behavior.at("error").get<std::string>();
  if (behavior.contains("outcome")) return name + ": " + behavior.at("outcome").get<std::string>();
  if (!behavior.value("plays", false)) return name + ": stopped";
  return name + (behavior.contains("state") ? " in " + behavior.at("state").get<std::string>() : " waits");
}

std::string status_text(const Json& answer) {
  char head[128];
  std::snprintf(head, sizeof head, "%.2f s, tick %lld", answer.at("time_s").get<double>(),
                static_cast<long long>(answer.at("tick").get<std::int64_t>()));
  std::string text = answer.at("name").get<std::string>() + " (" + answer.at("mode").get<std::string>() + ", process " +
                     std::to_string(answer.at("pid").get<int>()) + "): " + head + "\n";
  const Json& safety = answer.at("safety");
  text += "  safety   " + safety.at("level").get<std::string>();
  if (safety.contains("first"))
    text += ", " + std::to_string(safety.at("faults").get<std::uint32_t>()) + " faults, first " +
            safety.at("first").at("text").get<std::string>();
  text += "\n  sets     " + joined(answer.at("control_sets")) + "\n  plays    ";
  std::string playing = answer.value("behaviors_error", std::string());
  for (const Json& behavior : answer.value("behaviors", Json::array()))
    playing += (playing.empty() ? "" : "; ") + behavior_text(behavior);
  text += (answer.value("paused", false) ? "paused; " : "") + (playing.empty() ? "nothing" : playing) + "\n";
  const Json& record = answer.at("record");
  if (record.is_null()) return text + "  record   none\n";
  return text + "  record   " + record.at("file").get<std::string>() + ", " +
         std::to_string(record.at("rows").get<std::uint64_t>()) + " rows, " +
         std::to_string(record.at("dropped").get<std::uint32_t>()) + " dropped" +
         (record.at("failed").get<bool>() ? ", the disk failed" : "") + "\n";
}

std::string range_text(const Json& item) {
  if (!item.contains("min") && !item.contains("max")) return "";
  return (item.contains("min") ? number(item.at("min")) : "") + ".." +
         (item.contains("max") ? number(item.at("max")) : "");
}

std::string list_text(const Json& items) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& item : items) {
    std::vector<std::string> row{item.at("name").get<std::string>()};
    if (item.contains("value")) row.push_back(number(item.at("value")));
    if (item.contains("unit")) row.push_back(item.at("unit"));
    if (item.contains("value")) row.push_back(range_text(item));
    if (item.contains("type")) row.push_back(item.at("type"));
    if (item.contains("joints")) row.push_back(joined(item.at("joints")));
    if (item.contains("objects")) row.push_back(joined(item.at("objects")));
    if (item.contains("active")) row.emplace_back(item.at("active").get<bool>() ? "active" : "");
    if (item.contains("lane")) row.push_back(behavior_text(item).substr(row.front().size()));
    if (item.contains("doc")) row.push_back(item.at("doc"));
    rows.push_back(std::move(row));
  }
  return table(rows);
}

std::string value_text(const Json& answer) {
  const std::string unit = answer.at("unit");
  return number(answer.at("value")) + (unit.empty() ? "" : " " + unit) + "\n";
}

std::string change_text(const Json& change) {
  return change.at("name").get<std::string>() + ": " + number(change.at("before")) + " -> " + number(change.at("now")) +
         "\n";
}

std::string fault_list(const Json& answer) {
  std::string text = "safety level " + answer.at("level").get<std::string>() + ", " +
                     std::to_string(answer.at("since_clearing").get<std::uint32_t>()) +
                     " faults since the last clearing\n";
  for (const Json& fault : answer.at("faults"))
    text += "  " + fault.at("text").get<std::string>() + " (tick " +
            std::to_string(fault.at("tick").get<std::uint64_t>()) + ", " +
            std::to_string(fault.at("count").get<std::uint32_t>()) + " times)\n";
  return text;
}

std::string drives_text(const Json& answer) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& drive : answer.at("drives")) {
    const bool warm = drive.at("temperature_C").is_number();
    const auto code = drive.at("code").get<std::uint32_t>();
    rows.push_back({drive.at("joint"), drive.at("state"), warm ? number(drive.at("temperature_C")) + " C" : "",
                    drive.at("homed").get<bool>() ? "" : "not homed", drive.at("braked").get<bool>() ? "braked" : "",
                    code == 0 ? "" : "code " + std::to_string(code)});
  }
  std::string text = table(rows);
  if (answer.at("supply_V").is_number()) text += "supply " + number(answer.at("supply_V")) + " V\n";
  return text + (answer.at("emergency").get<bool>() ? "the emergency stop's button is pressed\n" : "");
}

// The parameters to which presets give other values, and how to change that.
std::string overridden_text(const Json& overridden) {
  std::string text, last;
  for (const Json& one : overridden) {
    const std::string name = one.at("name");
    text += (name == last ? ", " : (last.empty() ? "  " : "\n  ") + name + ": ") + one.at("preset").get<std::string>() +
            " sets " + number(one.at("value"));
    last = name;
  }
  return text.empty() ? ""
                      : "where a behavior chooses a preset, that counts, in the next run too:\n" + text +
                            "\n'kadans ctl save --preset NAME' writes what was set into one of them, too\n";
}

std::string save_text(const Json& answer) {
  if (!answer.contains("overridden")) return "nothing was changed\n";
  std::string text;
  for (const Json& change : answer.at("saved")) text += change_text(change);
  text += "saved in " + answer.at("file").get<std::string>();
  if (answer.contains("preset")) text += ", also in preset " + answer.at("preset").get<std::string>();
  return text + "\n" + overridden_text(answer.at("overridden"));
}

}  // namespace

std::string answer_text(const std::string& words, const Json& answer) {
  if (words == "status") return status_text(answer);
  if (words == "list") return list_text(answer.at("items"));
  if (words == "get") return value_text(answer);
  if (words == "set" || words == "undo") return change_text(answer);
  if (words == "save") return save_text(answer);
  if (words == "fault list") return fault_list(answer);
  if (words == "drives") return drives_text(answer);
  const std::string text = answer.value("text", std::string());
  return text.empty() ? "" : text + "\n";
}

std::string watch_head(const Json& answer) {
  std::string text = "time_s";
  for (const Json& signal : answer.at("signals")) text += "\t" + signal.at("name").get<std::string>();
  return text + "\n";
}

std::string watch_line(const Json& sample) {
  char time[32];
  std::snprintf(time, sizeof time, "%.3f", sample.at("time_s").get<double>());
  std::string text = time;
  for (const Json& value : sample.at("values")) text += "\t" + number(value);
  return text;
}

}  // namespace kadans
