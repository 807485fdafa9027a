#!/usr/bin/env bash
# Frames of a scene, each in parts, as an array of Slurm's, and a job that merges them when all are done.
#   tools/farm/slurm.sh SCENE FRAMES PARTS NAME [further arguments of vkvol ...]
#     FRAMES: 1-48, or still for a scene without the key F
#   SBATCH_ARGUMENTS="--partition=render --time=2:00:00"   for sbatch
#   VKVOL=PROGRAM                                          in place of vkvol
# Prints the number of the job that merges. A part that fails is tried three times more, and goes on where it ended, also when
# its node is lost and Slurm begins it again. NAME has to be in a directory that all nodes see.
set -euo pipefail
export LC_ALL=C # numbers have points

[ $# -ge 4 ] || { echo "slurm.sh: expected SCENE FRAMES PARTS NAME" >&2; exit 2; }
scene=$1 frames=$2 parts=$3 name=$4
shift 4
farm=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
first=0 count=1
if [ "$frames" != still ]; then
    first=${frames%-*}
    count=$((${frames#*-} - first + 1))
fi
read -r -a sbatch <<<"${SBATCH_ARGUMENTS:-}"
quoted=$(printf ' %q' "$@")

# frame INDEX: of the tasks, which go through the parts of one frame after another.
frame_text='frame=still; '
[ "$frames" = still ] || frame_text="frame=\$(($first + SLURM_ARRAY_TASK_ID / $parts)); "
render=$(sbatch "${sbatch[@]}" --parsable --requeue --job-name="vkvol $name" --output="$name.%a.log" \
    --array="0-$((count * parts - 1))" <<END
#!/usr/bin/env bash
export VKVOL=$(printf %q "${VKVOL:-vkvol}")
$frame_text part=\$((SLURM_ARRAY_TASK_ID % $parts + 1))
for attempt in 1 2 3 4; do
    bash $(printf %q "$farm")/render_part.sh $(printf %q "$scene") "\$frame" "\$part" $parts $(printf %q "$name")$([ $# -eq 0 ] || echo "$quoted") && exit
done
exit 1
END
)
sbatch "${sbatch[@]}" --parsable --job-name="vkvol $name, merge" --output="$name.merge.log" --dependency="afterok:$render" --kill-on-invalid-dep=yes <<END
#!/usr/bin/env bash
set -e
export VKVOL=$(printf %q "${VKVOL:-vkvol}")
for ((i = 0; i < $count; ++i)); do
    frame=$([ "$frames" = still ] && echo still || echo "\$(($first + i))")
    bash $(printf %q "$farm")/merge_frame.sh "\$frame" $parts $(printf %q "$name")
done
END
