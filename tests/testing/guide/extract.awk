# Blocks of a guide in Markdown as files: "```cpp NAME" adds to folder/NAME, every "```sh" and "```json" to folder/commands.sh
# and folder/configuration.json.   awk -v folder=DIR -f extract.awk GUIDE.md
function begin(name) {
  out = folder "/" name
  if (out in begun) print "" >> out
  else printf "" > out
  begun[out] = 1
}
/^```/ && out != "" { out = ""; next }
/^```cpp / { begin($2); next }
/^```sh$/ { begin("commands.sh"); next }
/^```json$/ { begin("configuration.json"); next }
/^```/ { print FILENAME ":" FNR ": a block that no test runs" > "/dev/stderr"; failed = 1 }
out != "" { print >> out }
END { exit failed }
