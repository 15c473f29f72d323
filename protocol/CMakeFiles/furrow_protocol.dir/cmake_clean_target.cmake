file(REMOVE_RECURSE
  "libfurrow_protocol.a"
)
