#!/bin/sh
# Submits the steps of ahm-tiles build to SLURM, one job per tile and step. Not tested with SLURM; the order was tested in a shell.
#   build_tiles.sh TILES_FOLDER NUMBER_OF_TILES     (ahm-tiles info prints the number)
after=""
for step in sort index planes measure cover mollify edges orient graph finish; do
  case $step in
    sort|planes|cover|edges|graph)
      job=$(sbatch --parsable $after --array=0-$(($2 - 1)) --mem=4G --wrap \
        "ahm-tiles step $1 $step --tile \$SLURM_ARRAY_TASK_ID --memory 3GB --threads 1") ;;
    *) job=$(sbatch --parsable $after --mem=8G --wrap "ahm-tiles step $1 $step") ;;
  esac
  after="--dependency=afterok:$job"
done
