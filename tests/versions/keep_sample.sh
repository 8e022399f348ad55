#!/usr/bin/env bash
# keep_sample.sh: keeps what this version writes, and what is written for it, beside this script in a folder named after the
# version. To be run once, at a release; tests/app/shipped/versions_test.cpp reads all samples.
set -euo pipefail
here=$(dirname "$(realpath "$0")")
tree=$(realpath "$here/../..")
kadans=${KADANS:-$tree/build/kadans}
folder=$here/$("$kadans" --version | cut -d' ' -f2)

rm -rf "$folder"
mkdir -p "$folder"/{config/scenarios,behaviors,models}
cp -r "$tree"/config/tulip "$folder/config"
cp -r "$tree"/models/tulip "$folder/models"
cp -r "$tree"/behaviors/{lib,tulip} "$folder/behaviors"
cp "$tree"/config/scenarios/squat.json "$folder/config/scenarios"
find "$folder" -name '*_test.lua' -delete
cd "$folder"
"$kadans" check config behaviors
"$kadans" sim config/scenarios/squat.json --duration 0.1 --record squat.mcap --signals 'joint.*_knee.*, base.*' >/dev/null || [ $? -eq 1 ]
"$kadans" run "$tree/config/jiwiy/robot.json" --plant ideal --play sine --duration 0.3 --threads-on-virtual-time --flight 0 \
  --record run.mcap --signals 'joint.*' >/dev/null
ls -l squat.mcap run.mcap
