#!/bin/sh
# Runs a stage of a make target and says how long it took: scripts/stage.sh NAME COMMAND [ARGUMENT]...
# Exit: that of the command.
name=$1
shift
start=$(date +%s)
"$@"
status=$?
echo "acstudy: $name in $(($(date +%s) - start)) s" >&2
exit $status
