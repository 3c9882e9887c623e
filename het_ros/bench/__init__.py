"""What a frame costs: the core beside its peers, as it scales, stage by stage; and the node."""
