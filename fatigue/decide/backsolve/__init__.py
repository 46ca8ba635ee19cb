"""What just meets the target: the load, curve, mileage, share or thickness, each proved by going forward."""
