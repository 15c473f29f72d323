# Empty custom commands generated dependencies file for furrow_protocol_schemas.
# This may be replaced when dependencies are built.
