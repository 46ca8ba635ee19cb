"""What is varied: values under keys of vehicle and case, the variants they make, and whether these can be."""
