// The verbs of `kadans log` that stand in files of their own, and what verbs have in common: spans of time, output
// files that are not overwritten by mistake, and output of lines.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "app/commands.h"
#include "telemetry/reading/record_rows.h"

namespace kadans {

// `kadans log`: shows what is in a record, without running anything.
struct LogOptions {
  std::string file, other;           // other: the second record of diff
  std::vector<std::string> signals;  // names or patterns
  std::vector<std::string> topics;
  std::optional<double> from_s, to_s, every_s;
  std::string out;
  double tolerance = 0;
  bool json = false;
  bool force = false, inputs = false;  // replaces an existing output file; a cut can be repeated
};

int log_info(const LogOptions& options);
int log_diff(const LogOptions& options);

// The span of --from and --to. Throws InputError when they do not make a span.
TimeSpan span_of(const LogOptions& options);
// Throws InputError when the span lies outside the record's time.
void require_overlap(const RecordOutline& record, TimeSpan span);
// Prints on stderr that a record is cut short; it is read as far as it goes.
void tell_problem(const McapReader& reader);
void tell_problem(const RecordOutline& record);
std::string plural(std::uint64_t count, const char* what);

// Throws InputError when the output file is the record, or when it exists and --force was not given.
void require_free(const LogOptions& options);

// An output file that has a temporary name until it is complete. A device or pipe is written to directly.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& file);  // throws InputError
  ~UnfinishedFile();                                           // removes an unfinished file
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  std::string path() const { return unfinished_.string(); }
  void finish();  // throws InputError

 private:
  std::filesystem::path file_, unfinished_;
  bool finished_ = false;
};

// Writes lines into a file or to stdout, whose reader may stop reading.
class LineOutput {
 public:
  explicit LineOutput(const std::string& file);  // "": stdout
  ~LineOutput();
  LineOutput(const LineOutput&) = delete;
  LineOutput& operator=(const LineOutput&) = delete;

  // False: the reader has stopped reading. Throws InputError when the line cannot be written.
  [[nodiscard]] bool put(std::string_view line);
  void finish();

 private:
  [[nodiscard]] bool failed() const;

  bool on_terminal_ = false;
  std::unique_ptr<UnfinishedFile> unfinished_;
  std::FILE* stream_;
  std::string name_;
};

}  // namespace kadans
