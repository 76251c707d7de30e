// Fits a manifest in parts and merges them (docs/cluster.md).
//
//     nextflow run main.nf --manifest /data/runs.csv --out /data/results --parts 20
//
// More: --slipfit PROGRAM where it is not on the PATH; --options "--tier damped", of slipfit batch. Paths are absolute: a task runs in
// a folder of its own, and the files of a manifest are found from the folder of the manifest.
nextflow.enable.dsl = 2

params.parts = 8
params.slipfit = "slipfit"
params.options = ""

// Exit code 1 is "finished, and some recordings failed": the task has done its work. A part that was killed goes on where it was.
process part {
    cpus 2
    errorStrategy "retry"
    maxRetries 2

    input:
    val number

    output:
    val "${params.out}/shard-${number}-of-${params.parts}"

    script:
    """
    ${params.slipfit} batch ${params.manifest} --out ${params.out}/shard-${number}-of-${params.parts} \
      --shard ${number}/${params.parts} --jobs ${task.cpus} --resume --quiet ${params.options} || [ \$? -eq 1 ]
    """
}

process merge {
    input:
    val folders

    script:
    """
    ${params.slipfit} merge ${folders.join(" ")} --out ${params.out}/all || [ \$? -eq 1 ]
    """
}

workflow {
    merge(part(Channel.of(1..params.parts)).collect())
}
