"""What the program stored, read into plain records: result files, benches, the ledger of statements, names."""
