include $(sort $(wildcard $(BR2_EXTERNAL_RELIEVO_PATH)/package/*/*.mk))
