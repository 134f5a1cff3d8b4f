#!/usr/bin/env bash
# A study over MPI ranks, one per node, as one Slurm job:
#
#   sbatch slurm-mpi.sh STUDY DIR
#
# DIR is on a file system that all nodes see. Submitted again, the job goes on where it was ended.
#SBATCH --job-name=kith
#SBATCH --nodes=4
#SBATCH --ntasks-per-node=1
#SBATCH --cpus-per-task=32
#SBATCH --mem=4G
#SBATCH --time=01:00:00
#SBATCH --signal=TERM@60
set -eu
study=$1 dir=$2
exec mpirun --bind-to none kith study "$study" -o "$dir" --threads "$SLURM_CPUS_PER_TASK" --progress none
