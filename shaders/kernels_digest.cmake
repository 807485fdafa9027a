# cmake -DLIST=FILE -DSYMBOL=NAME -DOUTPUT=FILE -P: a digest of the files of a list as text of a library, which one build
# can tell another's kernels by.
file(STRINGS ${LIST} files)
set(digests)
foreach(file ${files})
    file(SHA256 ${file} digest)
    string(APPEND digests ${digest})
endforeach()
string(SHA256 digest "${digests}")
string(SUBSTRING ${digest} 0 16 digest)
file(WRITE ${OUTPUT} ".section .note.GNU-stack,\"\",%progbits
.section .rodata
.global ${SYMBOL}
${SYMBOL}: .asciz \"${digest}\"
")
