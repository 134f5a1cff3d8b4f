#!/usr/bin/env bash
# A study in 100 shards as a Slurm job array:
#
#   sbatch slurm-shards.sh STUDY DIR
#
# A shard that is ended by its time limit goes on when it is submitted again; finished ones take a moment.
# When all are through: kith merge DIR/part-* -o DIR/whole
#SBATCH --job-name=kith
#SBATCH --array=1-100
#SBATCH --cpus-per-task=4
#SBATCH --mem=1G
#SBATCH --time=01:00:00
#SBATCH --signal=TERM@60
set -eu
study=$1 dir=$2
mkdir -p "$dir"
exec kith study "$study" -o "$dir/part-$SLURM_ARRAY_TASK_ID" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
  --threads "$SLURM_CPUS_PER_TASK" --progress none
