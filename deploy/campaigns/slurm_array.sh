#!/bin/sh
# A campaign as a Slurm job array, a share a task, and its report when all are done. CAMPAIGN and OUT are in the environment;
# OUT lies where all nodes see it. From the folder that holds build/, or with jaywalk on the PATH:
#   export CAMPAIGN=deploy/campaigns/paper.toml OUT=out/paper
#   job=$(sbatch --parsable --array=1-16 deploy/campaigns/slurm_array.sh)
#   sbatch --dependency=afterany:$job --wrap "jaywalk report $OUT"
# A task that was killed goes on when the same array is submitted again.
#SBATCH --job-name=jaywalk
#SBATCH --cpus-per-task=1
#SBATCH --output=jaywalk-%A_%a.txt
set -eu
PATH=$PWD/build:$PATH
exec jaywalk campaign "$CAMPAIGN" --out "$OUT" --jobs "${SLURM_CPUS_PER_TASK:-1}" \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
